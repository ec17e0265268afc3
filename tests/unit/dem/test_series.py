# SPDX-License-Identifier: GPL-3.0-or-later
"""The series of a bed over time, as the solvers write it."""

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.metrics import bed_metrics
from bedchain.dem.series import read_series
from bedchain.errors import UserError


def drum_series(tmp_path, **columns):
    given = {"time_s": np.arange(40) * 0.1, "mean_height_m": np.full(40, 0.05)} | columns
    pd.DataFrame(given).to_csv(tmp_path / "bed_series.csv", index=False)
    return tmp_path / "bed_series.csv"


def test_a_series_without_gas_gives_height_and_inclination(tmp_path):
    file = drum_series(tmp_path, surface_angle_rad=np.full(40, 0.4))
    found = {row["quantity"]: row["value"] for row in bed_metrics(read_series(file), 800.0, 1.0, 3.0)}
    assert found == {"particle_height_mean": pytest.approx(0.05), "surface_angle_mean": pytest.approx(0.4)}


def test_a_series_with_neither_gas_nor_inclination_is_refused(tmp_path):
    with pytest.raises(UserError, match="has no column pressure_drop_Pa"):
        read_series(drum_series(tmp_path))
