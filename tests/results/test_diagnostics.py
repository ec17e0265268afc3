# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of any bed's diagnostics."""

import numpy as np
import pandas as pd
import pytest

from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.registry import CHOSEN, load
from bedchain.measures.batch import share_by_cell, total_variation
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.frames import window

COLUMNS = ["quantity", "source", "lag_s", "time_s", "height_m", "part", "value", "unit", "ci_low", "ci_high"]
GROUPS = ("left", "right", "low", "up")
ESTIMATORS = ("literal", "per_step", "pooled")
ROUND_OFF = 1e-9
# digits of the table
DIGITS = 1e-6
# a chain that follows the bed at its own lag; more than that and the curves no longer look alike
LARGEST_ERROR = 0.2
# of a step, where a line between two groups cuts cells: their particles are spread over both sides
CUT_CELLS = 0.01
# a particle of half a million moves that ends in a cell which none leaves in the window: the estimator sends
# part of it elsewhere
DEAD_ENDS = 1e-5
# of Lacey's index at the start: where the line cuts no cell, and where the middle column holds both groups
START, CUT_START = 0.01, 0.03


@pytest.fixture(scope="module")
def table(results):
    """All rows."""
    return pd.read_csv(results / "diagnostics.csv")


@pytest.fixture(scope="module")
def models(case, results):
    """Names of the chains that have a transition matrix."""
    of = {name: load(results / f"transitions_{name}.npz") for name in of_case(case)}
    names = [name for name, chain in of.items() if isinstance(chain, MarkovChain)]
    assert {"static", "dynamic"} & set(names)
    return names


def of_case(case):
    """Models with the lag and the cells of the case; the chosen chain has its own, and no diagnostics."""
    return [name for name in case["chain"]["models"] if name != CHOSEN]


def part_of(table, quantity, source=None):
    rows = table[table["quantity"] == quantity]
    return rows if source is None else rows[rows["source"] == source]


def middle_is_cut(case):
    """Whether the line between left and right goes through a column of cells."""
    return case["cells"]["columns"] % 2 == 1


def test_columns_units_and_values(table):
    assert list(table.columns) == COLUMNS
    assert np.isfinite(table["value"]).all()
    assert set(table["unit"]) == {"1", "s", "m2/s", "1/s"}
    banded = table.dropna(subset=["ci_low", "ci_high"])
    assert (banded["ci_low"] <= banded["ci_high"] + ROUND_OFF).all()


def test_timescales_are_positive_and_fall(table, models, case):
    for model in models:
        rows = part_of(table, "implied_timescale", model)
        assert rows["lag_s"].min() == pytest.approx(case["chain"]["lag_s"])
        assert rows["lag_s"].nunique() >= 3
        for _, scales in rows.groupby("lag_s"):
            in_order = scales.assign(part=scales["part"].astype(int)).sort_values("part")["value"]
            assert (in_order > 0).all() and (in_order.diff().dropna() <= DIGITS * in_order.max()).all()
    static = part_of(table, "implied_timescale", "static")
    # for a longer lag the window may be too short for a band
    banded = static[np.isclose(static["lag_s"], case["chain"]["lag_s"])]
    assert len(banded) and banded["ci_low"].notna().all()


def test_mixing_time_belongs_to_the_slowest_process(table, models, case):
    lag = case["chain"]["lag_s"]
    for model in models:
        scales = part_of(table, "implied_timescale", model)
        slowest = scales.loc[np.isclose(scales["lag_s"], lag), "value"].max()
        gap = 1 - np.exp(-lag / slowest)
        assert part_of(table, "mixing_time", model)["value"].item() == pytest.approx(lag / gap, rel=1e-4)


def test_one_step_of_a_pooled_static_chain_is_what_was_counted(table, case):
    if case["chain"]["estimator"] != "pooled":
        pytest.skip("other estimators do not give back what was counted")
    seen = part_of(table, "remaining_counted").set_index(["part", "time_s"])["value"]
    steps = part_of(table, "remaining_propagated", "static")
    steps = steps[np.isclose(steps["lag_s"], steps["time_s"])]
    assert set(steps["part"]) == set(GROUPS)
    for row in steps.itertuples():
        cut = row.part in ("left", "right") and middle_is_cut(case)
        assert row.value == pytest.approx(seen[row.part, row.time_s], abs=CUT_CELLS if cut else DEAD_ENDS)


def test_chapman_kolmogorov_errors_are_small_and_in_their_bands(table, models, case):
    for model in models:
        rms = part_of(table, "chapman_kolmogorov_rms", model)
        own = rms[np.isclose(rms["lag_s"], case["chain"]["lag_s"])].set_index("part")
        assert set(own.index) == set(GROUPS)
        assert (own["value"] < LARGEST_ERROR).all()
        mean = part_of(table, "chapman_kolmogorov_mean", model)
        both = mean.merge(rms, on=["lag_s", "part"], suffixes=("_mean", ""))
        assert (both["value_mean"].abs() <= both["value"] + DIGITS).all()


def test_shares_still_on_their_side_are_shares(table):
    for quantity in ("remaining_counted", "remaining_propagated", "first_passage_share"):
        assert part_of(table, quantity)["value"].between(0, 1).all()


def test_residence_times_are_a_step_or_more_and_in_order(table, models, case):
    for model in models:
        times = part_of(table, "residence_time", model).set_index("part")["value"]
        assert case["chain"]["lag_s"] * (1 - DIGITS) <= times["shortest"] <= times["mean"] <= times["longest"]
        passage = part_of(table, "first_passage_time", model)["value"]
        assert len(passage) <= 1 and (passage > times["shortest"]).all()


def end_frames(table, model, case, results):
    """How far the long-run density of a pooled chain may be from the window's mean density [1].

    The mean over all steps' starts becomes that over their ends, which has the last frame for the first: each
    step adds that difference over the number of steps, and the chain forgets it within its longest timescale.
    """
    store = open_cells(results / "cells.npz")
    learned = store.cells[window(store.times_s, case["learning"]["start_s"], case["learning"]["end_s"])]
    first, last = (share_by_cell(learned[at], store.grid.n_cells) for at in (0, -1))
    scales, lag_s = part_of(table, "implied_timescale", model), case["chain"]["lag_s"]
    longest_s = scales[np.isclose(scales["lag_s"], lag_s)]["value"].max()
    steps = round((len(learned) - 1) * np.diff(store.times_s).mean() / lag_s)
    return total_variation(first, last) / steps / -np.expm1(-lag_s / longest_s)


def test_only_the_literal_estimator_leaks_and_the_pooled_one_keeps_the_density(table, models, case, results):
    for model in {"static", "dynamic"} & set(models):
        leak, error, distance = (
            part_of(table, name, model).set_index("part")["value"]
            for name in ("leak", "row_sum_error", "long_run_total_variation")
        )
        assert set(leak.index) == set(ESTIMATORS)
        assert leak["literal"] > 0 and leak["per_step"] == leak["pooled"] == 0
        assert error["literal"] > 0 and max(error["per_step"], error["pooled"]) < ROUND_OFF
        assert distance["pooled"] == distance.min() >= 0 and distance.max() <= 1
        assert distance["pooled"] < end_frames(table, model, case, results)


def test_lacey_index_goes_from_apart_to_mixed(table, case):
    for source in ("dem", *of_case(case)):
        for direction in ("radial", "axial"):
            rows = part_of(table, "lacey_index", source)
            curve = rows[rows["part"] == direction].sort_values("time_s")["value"]
            cut = direction == "radial" and middle_is_cut(case)
            assert curve.iloc[0] == pytest.approx(0, abs=CUT_START if cut else START)
            assert curve.iloc[-1] > 0.5 and curve.max() < 1.05


def test_dispersion_is_positive_in_every_layer(table, case):
    for axis in "xz":
        rows = part_of(table, f"dispersion_{axis}")
        assert set(rows["source"]) == {"dem", "dem_cells", *of_case(case)}
        assert (rows["value"] > 0).all()
        # one step of the static chain from one start moves particles about as far as the frames it knows
        step = rows[np.isclose(rows["lag_s"], rows["lag_s"].min())].pivot_table(
            index="height_m", columns="source", values="value"
        )
        assert (step["static"] / step["dem_cells"]).median() == pytest.approx(1, abs=0.2)


def test_difference_of_the_chains_is_a_distance(results, case):
    table = pd.read_csv(results / "figures" / "fig_difference.csv")
    by_moment = table.groupby("time_s")
    assert list(by_moment.groups) == pytest.approx(case["figures"]["moments_s"])
    half = 0.5 * by_moment["difference_1"].apply(lambda part: part.abs().sum())
    assert half.to_numpy() == pytest.approx(by_moment["total_variation_1"].first().to_numpy(), abs=DIGITS)
    assert half.between(0, 1).all() and (half > 0).all()
