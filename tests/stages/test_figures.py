# SPDX-License-Identifier: GPL-3.0-or-later
"""Times and figures of a bed of known motion: there in both forms, not blank, numbers beside them."""

import numpy as np
import pandas as pd
import pytest

from bedchain.chains.registry import ModelSettings
from bedchain.errors import UserError
from made.drawings import COLOURS, assert_drawn, outputs
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    LEARN,
    MODELS,
    MOMENTS,
    NUMBER,
    ROWS,
    SPLITS,
)
from plot_cells import plot_cells
from plot_cost import cost_table, plot_cost, readable_ratio, readable_seconds, where_it_ran
from plot_distribution import plot_distribution
from plot_mixing import bands, plot_mixing
from time_models import time_models


@pytest.fixture(scope="session")
def timing(bed):
    """Table of measured times."""
    time_models(
        bed.dem, bed.files, list(bed.transitions.values()), bed.timing,
        LEARN, COMPARE, SPLITS, ModelSettings("pooled", 1),
    )  # fmt: skip
    return pd.read_csv(bed.timing)


def test_fig1_has_every_cell_with_its_particles(bed, tmp_path):
    plot_cells(bed.files, outputs(tmp_path, "fig1"), COMPARE[0], DIAMETER, "#9aa5b1")
    table = assert_drawn(tmp_path, "fig1")
    assert table["particles_1"].sum() == NUMBER
    np.testing.assert_array_equal(table["cell"], np.arange(COLUMNS * ROWS))
    np.testing.assert_array_equal(table["cell"], table["row"] * COLUMNS + table["column"])


def test_fig1_of_a_frame_that_is_not_there_is_refused(bed, tmp_path):
    with pytest.raises(UserError, match="no frame at 7 s"):
        plot_cells(bed.files, outputs(tmp_path, "fig1"), 7.0, DIAMETER, "#9aa5b1")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("model", MODELS)
def test_figs3_and_4_show_chain_and_dem(bed, tmp_path, model):
    plot_distribution(
        bed.cells, bed.chains[model], outputs(tmp_path, "fig3"), model, COMPARE[0], BATCH, "YlGnBu"
    )
    table = assert_drawn(tmp_path, "fig3")
    totals = table.groupby(["source", "time_s"])["share_1"].sum()
    assert sorted(totals.index) == sorted((source, time) for source in ("dem", model) for time in MOMENTS)
    np.testing.assert_allclose(totals, 1, rtol=1e-6)


@pytest.mark.parametrize(("direction", "groups"), [("radial", {"left", "right"}), ("axial", {"low", "up"})])
def test_fig5_shows_both_groups(bed, tmp_path, direction, groups):
    plot_mixing(bed.mixing, bed.metrics, bed.chain_files, outputs(tmp_path, "fig5"), direction, COLOURS)
    table = assert_drawn(tmp_path, "fig5")
    assert set(table["group"]) == groups
    assert table["band_low_1"].isna().all()  # the learning window of the made bed is too short for a band


def test_fig5_has_the_bands_of_chains_learned_without_a_block(tmp_path):
    rng, times = np.random.default_rng(3), 0.1 * np.arange(20)
    remaining = np.linspace(0.95, 0.5, 20)[:, None] + np.zeros(4)
    left_out = remaining + rng.normal(0, 0.01, (5, 1, 4))
    groups = np.array(["left", "right", "low", "up"])
    chain = tmp_path / "chain_static.npz"
    np.savez(chain, times_s=times, groups=groups, remaining=remaining, remaining_left_out=left_out)
    table = bands({"static": chain})
    value = table["time_s"].map(dict(zip(np.round(times, 6), remaining[:, 0], strict=True)))
    assert (table["band_low_1"] < value).all() and (value < table["band_high_1"]).all()


def test_fig5_of_an_unknown_direction_is_refused(bed, tmp_path):
    with pytest.raises(UserError, match="no curves of direction 'azimuthal'"):
        plot_mixing(bed.mixing, bed.metrics, bed.chain_files, outputs(tmp_path, "fig5"), "azimuthal", COLOURS)


def test_timing_has_every_stage(timing):
    assert list(timing.columns) == ["stage", "wall_s", "cpu_s", "peak_rss_mb", "work", "work_unit"]
    kinds = ("count", "matrix", "exact", "monte_carlo")
    assert set(timing["stage"]) == {"dem", *(f"{model}_{kind}" for model in MODELS for kind in kinds)}
    assert (timing["wall_s"] > 0).all()
    kernels = timing[timing["stage"] != "dem"]
    assert (kernels["peak_rss_mb"] > 10).all()
    moves = kernels.set_index("stage").loc["static_monte_carlo"]
    assert (moves["work"], moves["work_unit"]) == (40 * NUMBER, "particle moves")


def test_fig2_has_the_ratios_to_the_dem(timing, bed, tmp_path):
    where = tmp_path / "provenance.json"
    where.write_text('{"machine": {"processor": "a processor"}}')
    plot_cost(bed.timing, bed.dem, [where], outputs(tmp_path, "fig2"), "#4477aa", 1.0)
    table = assert_drawn(tmp_path, "fig2").set_index(["model", "kind"])
    wall = timing.set_index("stage")["wall_s"]
    assert table.loc[("static", "exact"), "dem_over_this_1"] == pytest.approx(
        wall["dem"] / wall["static_exact"], rel=1e-6
    )
    assert table.loc[("dynamic", "learn"), "wall_s"] == pytest.approx(
        wall["dynamic_count"] + wall["dynamic_matrix"], rel=1e-6
    )


def test_fig2_says_where_it_ran(tmp_path):
    here, archive = tmp_path / "here.json", tmp_path / "archive.json"
    here.write_text('{"machine": {"processor": "fast"}}')
    archive.write_text('{"machine": {"processor": "slow"}}')
    assert where_it_ran(1, [here]) == "DEM: one core of fast. Chains: one core of fast."
    assert where_it_ran(2, [here, archive]) == "DEM: 2 cores of slow. Chains: one core of fast."


def test_fig2_without_the_dem_is_refused(timing):
    with pytest.raises(UserError, match="no stage 'dem'"):
        cost_table(timing[timing["stage"] != "dem"])


@pytest.mark.parametrize(
    ("value", "text"),
    [(93.4, "93 s"), (2.34, "2.3 s"), (0.0421, "42 ms"), (3.1e-6, "3.1 µs"), (4e-8, "4e-08 s")],
)
def test_seconds_are_readable(value, text):
    assert readable_seconds(value) == text


def test_ratios_are_readable():
    assert [readable_ratio(value) for value in (3.14, 22345.0, 1.6e6)] == [
        "3.1",
        "22\u2009000",
        "1\u2009600\u2009000",
    ]
