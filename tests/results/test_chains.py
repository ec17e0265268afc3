# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of the chains and their comparison with the DEM, and what is expected of this case."""

import hashlib
import json
import re

import numpy as np
import pandas as pd
import pytest

from bedchain.chains import registry
from bedchain.chains.markov_chain import MarkovChain
from bedchain.comparison.expected import deviations, read_expected
from bedchain.provenance import case_hash

# row sums and masses: round-off of some hundred additions
ROUND_OFF = 1e-10
# standard errors of a Monte Carlo, over some thousand values
SIGMAS = 6.0
MIXING_COLUMNS = ["time_s", "source", "direction", "group", "fraction_remaining_1"]
METRICS_COLUMNS = ["quantity", "source", "value", "unit", "ci_low", "ci_high"]
TIMING_COLUMNS = ["stage", "wall_s", "cpu_s", "peak_rss_mb", "work", "work_unit"]
GROUPS = {"left": "radial", "right": "radial", "low": "axial", "up": "axial"}


@pytest.fixture(scope="module")
def mixing(results):
    """Curves of Fig. 5."""
    return pd.read_csv(results / "mixing.csv")


def sources(case):
    return ["dem", *(f"{model}{how}" for model in case["chain"]["models"] for how in ("", "_monte_carlo"))]


def test_chains_keep_their_particles(results, case):
    for model in case["chain"]["models"]:
        chain = registry.load(results / f"transitions_{model}.npz")
        if isinstance(chain, MarkovChain):
            np.testing.assert_allclose(chain.matrix.sum(axis=1), 1, atol=ROUND_OFF)
        with np.load(results / f"chain_{model}.npz") as run:
            for name in ("batch_share", "batch_share_monte_carlo"):
                assert (run[name] >= 0).all()
                np.testing.assert_allclose(run[name].sum(axis=1), 1, atol=ROUND_OFF)


def test_monte_carlo_agrees_with_the_exact_expectation(results, case, metrics):
    for model in case["chain"]["models"]:
        with np.load(results / f"chain_{model}.npz") as run:
            exact, drawn = run["remaining"], run["remaining_monte_carlo"]
        size = [
            case["particles"]["number"] * metrics.loc[("dem", f"share_start_{g}"), "value"] for g in GROUPS
        ]
        error = np.sqrt(np.maximum(exact * (1 - exact), 1e-3) / size)
        assert (np.abs(drawn - exact) < SIGMAS * error).all()


def test_mixing_table_is_complete(mixing, case):
    assert list(mixing.columns) == MIXING_COLUMNS
    repeats = [f"dem_{number}" for number in range(1, case["comparison"]["repeats"] + 1)]
    assert list(dict.fromkeys(mixing["source"])) == ["dem", *repeats, *sources(case)[1:]]
    assert mixing["fraction_remaining_1"].between(0, 1).all()
    for (_, group), curve in mixing.groupby(["source", "group"]):
        assert set(curve["direction"]) == {GROUPS[group]}
        assert curve["time_s"].is_monotonic_increasing
        assert curve["time_s"].iloc[0] == pytest.approx(case["comparison"]["start_s"])
        assert curve["time_s"].iloc[-1] == pytest.approx(case["comparison"]["end_s"])
        assert curve["fraction_remaining_1"].iloc[0] == pytest.approx(1)
    assert set(mixing["group"]) == set(GROUPS)


def test_metrics_are_complete_and_finite(results, metrics, case):
    assert list(pd.read_csv(results / "metrics.csv").columns) == METRICS_COLUMNS
    assert np.isfinite(metrics["value"]).all()
    assert not metrics.index.duplicated().any()
    for group in GROUPS:
        for quantity in ("share_start", "share_end", "share_mean", "crossed_end"):
            assert ("dem", f"{quantity}_{group}") in metrics.index
        for source in sources(case)[1:]:
            for quantity in ("error_signed", "error_rms", "crossed_end"):
                assert (source, f"{quantity}_{group}") in metrics.index
    banded = metrics.dropna(subset=["ci_low", "ci_high"])
    assert (banded["ci_low"] <= banded["ci_high"]).all()
    for model in case["chain"]["models"]:
        assert {(model, f"error_rms_{group}") for group in GROUPS} <= set(banded.index)


def test_repeats_give_a_noise_floor_beside_every_error(metrics, case):
    repeats = case["comparison"]["repeats"]
    assert (("dem", "realisations") in metrics.index) == (repeats > 0)
    for group in GROUPS if repeats else ():
        floor = metrics.loc[("dem", f"noise_floor_{group}")]
        assert 0 < floor["ci_low"] < floor["value"] < floor["ci_high"]
        for source in sources(case)[1:]:
            over = metrics.loc[(source, f"error_over_noise_{group}"), "value"]
            error = metrics.loc[(source, f"error_rms_{group}"), "value"]
            assert over == pytest.approx(error / floor["value"], rel=1e-6)
            assert (source, f"error_rms_of_mean_{group}") in metrics.index


def test_shares_of_both_sides_make_one(metrics):
    for when in ("start", "end", "mean"):
        for sides in (("left", "right"), ("low", "up")):
            shares = [metrics.loc[("dem", f"share_{when}_{side}"), "value"] for side in sides]
            assert sum(shares) == pytest.approx(1, abs=1e-6)
            assert min(shares) > 0


def test_timing_has_the_dem_and_every_chain(results, case):
    timing = pd.read_csv(results / "timing.csv")
    assert list(timing.columns) == TIMING_COLUMNS
    both = ("exact", "monte_carlo")
    kinds = {"static": ("count", "matrix", *both), "dynamic": ("count", "matrix", *both)}
    for model in case["chain"]["models"]:
        assert set(timing["stage"]) >= {"dem", *(f"{model}_{k}" for k in kinds.get(model, ("learn", *both)))}
    assert (timing["wall_s"] > 0).all()


def test_provenance_names_what_made_the_results(results, case):
    provenance = json.loads((results / "provenance.json").read_text())
    files = {"dem": "dem.json", "metrics": "metrics.csv", "timing": "timing.csv"}
    hashes = {key: hashlib.sha256((results / name).read_bytes()).hexdigest() for key, name in files.items()}
    assert provenance["sha256"] == hashes
    values = provenance["case"]["values"]
    assert provenance["case"]["sha256"] == case_hash(values)
    assert values.items() <= case.items() and {"particles", "cells", "chain"} <= values.keys()
    assert provenance["seeds"] == {"particles": case["seed"], "chain": case["chain"]["seed"]}
    assert re.fullmatch("[0-9a-f]{40}", provenance["git"]["commit"])
    assert provenance["packages"]["python"]["numpy"] == np.__version__
    assert provenance["packages"]["debian"]["liggghts"] and provenance["machine"]["cores"] > 0
    jobs = {
        f"{job}_{model}" for job in ("build_transitions", "run_chain") for model in case["chain"]["models"]
    }
    assert jobs <= provenance["times"].keys()
    assert all(job["wall_s"] > 0 for job in provenance["times"].values())


def test_case_gives_what_is_expected_of_it(case_folder, results):
    expected = read_expected(case_folder / "expected.csv")
    assert len(expected) > 0 and expected["reason"].notna().all()
    assert not deviations(expected, pd.read_csv(results / "metrics.csv", dtype={"unit": str}))
