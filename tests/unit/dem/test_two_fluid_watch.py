# SPDX-License-Identifier: GPL-3.0-or-later
"""Watch over a two-fluid run and its progress, without the solver."""

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.dem.two_fluid_start import grid_of, start_solids
from bedchain.dem.two_fluid_watch import Progress, check_solids, fastest_place
from bedchain.errors import UserError
from made import ROOT


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def watched(gas, name, values):
    file = gas / "postProcessing" / name / "0" / f"{name}.dat"
    file.parent.mkdir(parents=True)
    lines = [f"{0.025 * (at + 1):g}\t{value:.9e}" for at, value in enumerate(values)]
    file.write_text("# Time value\n" + "\n".join(lines) + "\n")


@pytest.mark.parametrize(("factor", "stops"), [(1.0, False), (1.0005, False), (0.998, True), (1.0011, True)])
def test_solids_that_drift_stop_the_run_with_the_time(case, tmp_path, factor, stops):
    mean = start_solids(case).mean()
    watched(tmp_path, "solids", [mean, factor * mean])
    watched(tmp_path, "largest", [0.55, 0.6])
    watched(tmp_path, "left", [0.0, 0.0])
    if not stops:
        check_solids(tmp_path, case, (0, 0.05))
        return
    with pytest.raises(UserError, match=r"at 0.05 s the solids' mass is [-+]0.\d+% off, more than 0.1%"):
        check_solids(tmp_path, case, (0, 0.05))


def test_solids_that_leave_at_the_top_are_no_drift(case, tmp_path):
    mean, whole = start_solids(case).mean(), 2600 * 9000 * np.pi / 6 * 1e-9
    watched(tmp_path, "solids", [0.996 * mean, 0.99 * mean])
    watched(tmp_path, "largest", [0.55, 0.6])
    # 0.4 % before, and 0.6 % in the last step
    watched(tmp_path, "left", [0.0, 0.006 * whole / case["time"]["gas_step_s"]])
    assert check_solids(tmp_path, case, (0, 0.05), 0.004 * whole) == pytest.approx(0.006 * whole)


def test_solids_above_their_packing_limit_are_named_with_time_and_place(case, tmp_path):
    grid = grid_of(case)
    watched(tmp_path, "solids", [start_solids(case).mean()] * 2)
    watched(tmp_path, "largest", [0.55, 0.66])
    watched(tmp_path, "left", [0.0, 0.0])
    (tmp_path / "0.05").mkdir()
    solids = np.full((grid.rows, grid.columns), 0.3)
    solids[3, 5] = 0.66
    head = b"internalField nonuniform List<scalar> %d\n("
    faces = grid.rows * (grid.columns - 1) + (grid.rows - 1) * grid.columns
    for name, values in (("alpha.particles", solids), ("alphaRhoPhi.particlesMean", np.zeros(faces))):
        (tmp_path / "0.05" / name).write_bytes(head % values.size + values.tobytes() + b")")
    with pytest.raises(UserError, match=r"at 0.05 s a cell has 0.660 .* 0.605 .*x 0.0275 m, z 0.0175 m"):
        check_solids(tmp_path, case, (0, 0.05))


def test_progress_takes_time_and_cost_of_the_solver_s_lines(capsys):
    progress = Progress(2.0, 1.0)
    progress.last -= 60
    for line in ("Time = 1.5\n", "ExecutionTime = 12.5 s  ClockTime = 13 s\n", "PIMPLE: iteration 1\n"):
        progress(line)
    assert progress.now_s == 1.5 and progress.cpu_s == 12.5
    assert "two_fluid: 1.500 of 2 s simulated" in capsys.readouterr().err


def test_the_place_of_the_fastest_solids_is_named(case, tmp_path):
    assert fastest_place(tmp_path, case) == ""
    grid = grid_of(case)
    speeds = np.zeros((grid.n_cells, 3))
    speeds[3 * grid.columns + 5, 2] = -40.0
    (tmp_path / "0.05").mkdir()
    text = b"internalField nonuniform List<vector> %d\n(" % grid.n_cells
    (tmp_path / "0.05" / "U.particles").write_bytes(text + speeds.tobytes() + b")")
    assert "fastest solids at 0.05 s: 40 m/s, x 0.0275 m, z 0.0175 m" in fastest_place(tmp_path, case)
