# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a two-fluid run, without the solver."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.dem.two_fluid import lost_until, read_run
from bedchain.errors import UserError
from bedchain.files import write_arrays


def segment(folder, times_s, **record):
    folder.mkdir()
    count = len(times_s)
    shapes = {"solids": (count, 2, 2), "right": (count, 2, 1), "up": (count, 1, 2)}
    fields = {name: np.full(shape, times_s[0], np.float32) for name, shape in shapes.items()}
    write_arrays(folder / "flow.npz", {"times_s": np.array(times_s), **fields})
    pd.DataFrame({"time_s": times_s, "pressure_drop_Pa": 1.0, "solids_drift_1": 0.0}).to_csv(
        folder / "series.csv", index=False
    )
    (folder / "segment.json").write_text(json.dumps(record))


def test_segments_are_joined_with_their_cost_and_those_without_a_balance_too(tmp_path):
    segment(tmp_path / "segment_0001", [0.1, 0.2], start_s=0.0, end_s=0.2, cpu_s=4.0, lost_kg=0.5)
    segment(tmp_path / "segment_0002", [0.3], start_s=0.2, end_s=0.3, cpu_s=5.0)
    run = read_run(tmp_path)
    np.testing.assert_allclose(run.flow.times_s, [0.1, 0.2, 0.3])
    assert run.flow.up.shape == (3, 1, 2) and len(run.series) == 3 and run.balance.empty
    assert run.cpu_s_per_s == pytest.approx(30.0)
    assert lost_until(tmp_path / "segment_0001") == 0.5 and lost_until(tmp_path / "segment_0003") == 0.0


def test_a_run_without_a_finished_segment_is_refused(tmp_path):
    (tmp_path / "segment_0001").mkdir()
    with pytest.raises(UserError, match="holds no finished segment"):
        read_run(tmp_path)
