# SPDX-License-Identifier: GPL-3.0-or-later
"""Scores as rows, for errors that are known."""

import numpy as np
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.scores import rows
from bedchain.studies.scores.held_out import hold_out
from bedchain.studies.scores.predictions import dem_statistics
from bedchain.trajectory.grid import Grid
from made.frames import walkers


@pytest.fixture(scope="module")
def held():
    """Two realisations with a second held out."""
    runs = [walkers(80, seed=seed) for seed in (1, 2)]
    return hold_out(runs, Grid(0.1, 0.1, 5, 5), (1.0, 2.0), 10, Splits(0.05, 0.05), 0.02, [0.1, 0.3])


def by(table, *keys):
    return {tuple(row[key] for key in keys): row for row in table}


def test_times_that_curves_reach_and_all_frames_together():
    curves = np.arange(50.0)[None, :, None]
    found = rows.at_times(curves, 0.025)
    assert [time for time, _ in found[1:]] == [0.1, 0.25, 0.5, 1.0]
    assert np.isnan(found[0][0]) and found[0][1] is curves
    # the first frame is one interval after the start
    assert [part.item() for _, part in found[1:]] == [3, 9, 19, 39]


def test_a_constant_error_is_the_score_and_stands_beside_the_noise(held):
    error = np.where(np.isnan(held.curves), np.nan, np.array([0.1, -0.1, 0.2, 0.2]))
    which = held.windows()["starts"]
    scores = by(rows.curve_rows(error, held, "starts", which), "quantity", "time_s")
    signed = scores["error_signed_axial", 0.25]
    assert [signed[key] for key in ("value", "ci_low", "ci_high")] == pytest.approx([0.2] * 3)
    # left and right cancel in the mean and not in the rms
    assert scores["error_signed_radial", 0.25]["value"] == pytest.approx(0, abs=1e-12)
    assert scores["error_rms_radial", 0.25]["value"] == pytest.approx(0.1)
    deviations = held.deviations()[:, 1:][:, 9, 2:]
    assert scores["error_rms_axial", 0.25]["noise_floor"] == pytest.approx(
        np.sqrt(np.nanmean(deviations**2)), rel=1e-9
    )


def test_the_batch_has_a_row_a_moment_and_their_mean(held):
    error = np.full((6, 2, 1), 0.3)
    error[:, 1] = 0.5
    scores = by(rows.batch_rows(error, held, "starts", held.windows()["starts"]), "time_s")
    values = [row["value"] for row in scores.values()]
    assert values == pytest.approx([0.3, 0.5, 0.4])
    assert all(row["noise_floor"] > 0 for row in scores.values())


def test_the_spread_of_the_dem_is_its_own_deviation(held):
    table = by(rows.spread_rows("spread", held.deviations(), held, "starts"), "quantity", "time_s")
    expected = np.sqrt(np.nanmean(held.deviations()[:, 10] ** 2))
    assert table["spread_mixing", 0.25]["value"] == pytest.approx(expected)


def test_a_model_that_is_the_dem_has_no_error_of_dispersion_and_a_floor_only_beside_a_second_run(held):
    dems = [dem_statistics(held, number) for number in (0, 1)]
    both = by(rows.dispersion_rows([(dem, dem) for dem in dems]), "quantity")
    alone = by(rows.dispersion_rows([(dems[0], dems[0])]), "quantity")
    assert both.keys() == alone.keys() and len(both) == 4
    for name, row in both.items():
        assert row["value"] == alone[name]["value"] == pytest.approx(0, abs=1e-12)
        assert row["noise_floor"] > 0 and np.isnan(alone[name]["noise_floor"])


def test_a_row_has_empty_places_where_nothing_is_known():
    row = rows.row("leak", 0.25)
    assert row["value"] == 0.25 and np.isnan([row[key] for key in ("time_s", "ci_low", "noise_floor")]).all()
