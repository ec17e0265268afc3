# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of a realisation: mixing time and granular temperature."""

from types import SimpleNamespace

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.studies.tradeoff.reference import granular_temperature, mixing_time, own_grid


def test_mixing_time_of_an_exponential_is_its_time_constant():
    time = 0.025 * np.arange(100)
    apart = np.exp(-time / 0.4)
    one, other = 0.6 + 0.4 * apart, 0.4 + 0.6 * apart
    assert mixing_time(one, other, 0.025) == pytest.approx(0.4, rel=1e-3)
    assert np.isnan(mixing_time(one[:10], other[:10], 0.025))


def test_cells_that_are_no_flat_boxes_are_refused():
    run, cells = SimpleNamespace(width_m=0.1, height_m=0.2), {"columns": 4, "rows": 5}
    assert own_grid(run, {"cells": cells | {"form": "boxes", "layers": 1}}).n_cells == 20
    with pytest.raises(DataError, match="flat boxes only, and the cells are sectors"):
        own_grid(run, {"cells": cells | {"form": "sectors"}})


def test_granular_temperature_is_that_of_a_loop_and_of_the_theory():
    rng = np.random.default_rng(4)
    cells = rng.integers(0, 30, (5, 2000)).astype(np.int32)
    drift = rng.normal(0, 1.0, 30)[cells]
    vx, vz = (drift + rng.normal(0, 0.2, cells.shape) for _ in range(2))
    found = granular_temperature(cells, vx, vz, 40)
    squares, freedom = 0.0, 0
    for frame in range(5):
        for cell in range(40):
            inside = cells[frame] == cell
            for v in (vx[frame, inside], vz[frame, inside]):
                squares += ((v - v.mean()) ** 2).sum() if v.size else 0.0
            freedom += max(int(inside.sum()) - 1, 0)
    assert found == pytest.approx(squares / (2 * freedom))
    # sampling error of 20 000 squares is 1 %
    assert found == pytest.approx(0.04, rel=0.05)
    assert np.isnan(granular_temperature(np.array([[0, 1]], np.int32), vx[:1, :2], vz[:1, :2], 2))
