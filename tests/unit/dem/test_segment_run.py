# SPDX-License-Identifier: GPL-3.0-or-later
"""A segment that its solver left incomplete; runs are in test_run.py, the real solvers in tests/solver."""

from pathlib import Path

import pytest

from bedchain.dem import segment_run
from bedchain.dem.run import run_dem
from bedchain.errors import UserError


@pytest.mark.parametrize("name", ["particles.restart", "frame_25000.bin"])
def test_a_solver_that_ends_well_on_a_full_disk_is_not_believed(folder, starts, monkeypatch, name):
    times, _ = starts
    solver = segment_run.run_logged

    def on_a_full_disk(command, log, progress, silence_s):
        solver(command, log, progress, silence_s)
        (log.parent / name).write_bytes((log.parent / name).read_bytes()[:20])

    monkeypatch.setattr(segment_run, "run_logged", on_a_full_disk)
    with pytest.raises(UserError, match=f"(?s)segment_0001 is not complete.*{Path(name).name}.*are free"):
        run_dem(folder, 0.5, 0.5, 1)
    monkeypatch.setattr(segment_run, "run_logged", solver)
    run_dem(folder, 0.5, 0.5, 1)
    assert times == ["in.settle", 0.0, 0.0]
