# SPDX-License-Identifier: GPL-3.0-or-later
"""Every model goes through every stage, by its name alone."""

import numpy as np
import pandas as pd
import pytest

import run_chain
import time_models
from bedchain.chains import registry
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.curves import ChainFiles
from bedchain.measures.batch import Batch
from bedchain.uncertainty import bands
from build_transitions import build_transitions
from compare_mixing import SolverSeries, Tables, compare_mixing
from diagnose_chains import diagnose_chains
from made.drawings import assert_drawn, outputs
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    LEARN,
    MOMENTS,
    ROWS,
    SPLITS,
    WEIGHT_PA,
)
from plot_chapman_kolmogorov import plot_chapman_kolmogorov
from plot_cost import plot_cost
from plot_mixing import plot_mixing
from plot_timescales import plot_timescales

NAMES = list(registry.LEARNERS)
COLOURS = {"dem": "black", **dict.fromkeys(NAMES, "tab:blue")}
OPTIONS = {
    "velocity_class": {"classes": [2, 3]},
    "jump": {"classes": [2, 1]},
    "recurrence": {"neighbours": 2},
}
STEPS = 40


@pytest.fixture(scope="module")
def chains(bed, tmp_path_factory):
    """Transitions and chains of all models, by name."""
    folder = tmp_path_factory.mktemp("models")
    made = {
        kind: {name: folder / f"{kind}_{name}.npz" for name in NAMES} for kind in ("transitions", "chain")
    }
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(bands, "FEWEST_CORRELATION_TIMES", 0)
        for name in NAMES:
            path, options = made["transitions"][name], OPTIONS.get(name, {})
            build_transitions(bed.files, path, name, "pooled", 0.025, LEARN, options)
            run_chain.run_chain(
                bed.files, path, made["chain"][name], LEARN, COMPARE, SPLITS, Batch(BATCH, MOMENTS),
                ModelSettings("pooled", 3, options),
            )  # fmt: skip
    return made


@pytest.mark.parametrize("name", NAMES)
def test_a_model_is_learned_and_run(chains, name):
    assert registry.load(chains["transitions"][name]).name == name
    with np.load(chains["chain"][name]) as chain:
        assert chain["remaining"].shape == (STEPS + 1, 4)
        assert ((chain["remaining"] >= 0) & (chain["remaining"] <= 1)).all()
        assert chain["remaining_left_out"].shape == (5, STEPS + 1, 4)
        assert (chain["remaining_left_out"] != chain["remaining"]).any()
        assert chain["batch_share_left_out"].sum(axis=2) == pytest.approx(1)
        assert chain["batch_share"].shape == (len(MOMENTS), COLUMNS * ROWS)
        assert chain["batch_share"].sum(axis=1) == pytest.approx(1)


def test_options_reach_the_models(chains):
    learned = {name: registry.load(chains["transitions"][name]) for name in NAMES}
    assert learned["velocity_class"].classes.number == 6
    assert learned["jump"].classes.number == 2
    assert learned["recurrence"].settings.neighbours == 2


def test_all_models_are_compared_and_drawn(bed, chains, tmp_path):
    mixing, metrics = tmp_path / "mixing.csv", tmp_path / "metrics.csv"
    files = ChainFiles(NAMES, list(chains["chain"].values()))
    compare_mixing(
        bed.files, files, SolverSeries(bed.series, LEARN, WEIGHT_PA), [], Tables(mixing, metrics), COMPARE,
        SPLITS, BATCH,
    )  # fmt: skip
    both = [f"{name}{how}" for name in NAMES for how in ("", "_monte_carlo")]
    assert list(dict.fromkeys(pd.read_csv(mixing)["source"])) == ["dem", *both]
    plot_mixing(mixing, metrics, files, outputs(tmp_path, "fig5"), "radial", COLOURS)
    assert set(assert_drawn(tmp_path, "fig5")["source"]) == {"dem", *both}


def test_all_models_are_timed(bed, chains, tmp_path, monkeypatch):
    monkeypatch.setattr(time_models, "REPEATS", 1)
    monkeypatch.setattr(time_models, "FEWEST", 1)
    timing = tmp_path / "timing.csv"
    time_models.time_models(
        bed.dem, bed.files, list(chains["transitions"].values()), timing, LEARN, COMPARE, SPLITS,
        ModelSettings("pooled", 1, OPTIONS),
    )  # fmt: skip
    where = tmp_path / "provenance.json"
    where.write_text('{"machine": {"processor": "a processor"}}')
    plot_cost(timing, bed.dem, [where], outputs(tmp_path, "fig2"), "#4477aa", 1.0)
    table = assert_drawn(tmp_path, "fig2").set_index(["model", "kind"])
    for name in NAMES:
        assert (table.loc[name].loc[["learn", "exact", "monte_carlo"], "wall_s"] > 0).all()


def test_timescales_are_given_of_models_with_a_matrix(bed, chains, tmp_path):
    path = tmp_path / "diagnostics.csv"
    names = ("velocity_class", "jump", "recurrence")
    few = {name: chains["transitions"][name] for name in names}
    diagnose_chains(
        bed.files, list(few.values()), path, tmp_path / "modes.csv", LEARN, COMPARE, SPLITS,
        ModelSettings("pooled", 3, OPTIONS),
    )  # fmt: skip
    table = pd.read_csv(path)
    assert isinstance(registry.load(few["velocity_class"]), MarkovChain)
    assert set(table.query("quantity == 'implied_timescale'")["source"]) == {"velocity_class"}
    assert set(table.query("quantity == 'lacey_index'")["source"]) == {"dem", *names}
    colours = {name: COLOURS[name] for name in names}
    plot_timescales(path, outputs(tmp_path, "ts"), colours)
    assert (assert_drawn(tmp_path, "ts")["timescale_s"] > 0).all()
    plot_chapman_kolmogorov(path, outputs(tmp_path, "ck"), {"dem": "black"} | colours)
    assert_drawn(tmp_path, "ck")
    distance = table.query("quantity == 'long_run_total_variation'").set_index("source")["value"]
    assert set(distance.index) == set(names) and distance.between(0, 0.3).all()
    shares = table.query("quantity == 'first_passage_share'")
    assert len(shares) == 1 + len(names) and (shares["value"].between(0, 1)).all()


def test_short_runs_are_timed_often_and_long_ones_twice():
    assert not time_models.are_enough([0.1, 0.1]) and time_models.are_enough([0.1] * 3)
    assert not time_models.are_enough([0.01] * 14) and time_models.are_enough([0.01] * 15)
    assert not time_models.are_enough([0.6]) and time_models.are_enough([0.6, 0.7])
    assert not time_models.are_enough([0.9, 0.4])  # the first has compiled
