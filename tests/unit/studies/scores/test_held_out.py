# SPDX-License-Identifier: GPL-3.0-or-later
"""What the DEM does after the learning window, against loops over its positions."""

import numpy as np
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.scores.held_out import hold_out
from bedchain.trajectory.grid import Grid
from made.frames import walkers

GRID = Grid(0.1, 0.1, 5, 10)


def held(*seeds):
    """Runs of 2 s, of which the last second is held out, with a start every 10 frames."""
    runs = [walkers(80, seed=seed) for seed in seeds]
    return hold_out(runs, GRID, (1.0, 2.0), 10, Splits(0.05, 0.05), 0.02, [0.1, 0.8])


def test_starts_of_all_runs_with_their_curves_and_batches():
    found = held(1, 2)
    assert (
        found.run_of_start.tolist() == [0, 0, 0, 1, 1, 1] and found.number_in_window.tolist() == [0, 1, 2] * 2
    )
    assert [start.frame for start in found.starts[:3]] == [40, 50, 60]
    values = found.runs[1].values
    low = np.floor(values[50, 1] / 0.01) < 2
    assert (found.batches[4] == low).all()
    later = GRID.cell_of(values[54, 0], values[54, 1])[low]
    assert found.densities[4, 0] == pytest.approx(np.bincount(later, minlength=50) / low.sum())
    # 0.8 s after the third start is beyond the end
    assert np.isnan(found.densities[5, 1]).all() and np.isfinite(found.densities[3, 1]).all()
    assert np.isnan(found.curves[4, 31:]).all() and np.isfinite(found.curves[4, :31]).all()
    down = values[50, 1] < 0.05
    assert found.curves[4, 20, 2] == pytest.approx((values[70, 1][down] < 0.05).mean())


def test_windows_and_what_their_noise_floor_is_the_spread_of():
    many, single = held(1, 2), held(1)
    windows = {name: which.tolist() for name, which in many.windows().items()}
    assert windows == {
        "start": [True] + [False] * 5, "starts": [True] * 6, "repeats": [False] * 3 + [True] + [False] * 2,
    }  # fmt: skip
    assert many.repeated and many.floor_of("start").tolist() == [True, False, False] * 2
    assert set(single.windows()) == {"start", "starts"} and single.floor_of("start").all()


def test_equal_realisations_leave_no_noise_and_the_starts_still_differ():
    twice = held(1, 1)
    assert np.nanmax(np.abs(twice.deviations())) == 0 and np.nanmax(twice.batch_distances()) == 0
    assert np.nanmax(np.abs(twice.deviations_of_starts())) > 0.01
    assert np.nanmax(np.abs(held(1, 2).deviations())) > 0.01
