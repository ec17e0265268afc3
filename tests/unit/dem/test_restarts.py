# SPDX-License-Identifier: GPL-3.0-or-later
"""What solvers leave on a disk that is full: each file that is not complete is refused by its name."""

import shutil

import pytest

from bedchain.dem.restarts import GAS_FIELDS, check_gas, check_restart, check_series, complete
from bedchain.errors import DataError, UserError
from made.solver_files import write_gas, write_restart, write_series


@pytest.mark.parametrize("ranks", [1, 3])
def test_a_whole_restart_passes(tmp_path, ranks):
    write_restart(tmp_path / "restart", 50, ranks)
    check_restart(tmp_path / "restart", 50)
    with pytest.raises(DataError, match="restart is no whole restart of 51 particles"):
        check_restart(tmp_path / "restart", 51)


def test_a_restart_cut_off_anywhere_is_refused(tmp_path):
    write_restart(tmp_path / "whole", 20, 2)
    content = (tmp_path / "whole").read_bytes()
    for size in (0, 1, 100, len(content) // 2, len(content) - 8, len(content) - 1):
        (tmp_path / "cut").write_bytes(content[:size])
        with pytest.raises(DataError, match="cut is no whole restart"):
            check_restart(tmp_path / "cut", 20)
    with pytest.raises(DataError, match="none cannot be read"):
        check_restart(tmp_path / "none", 20)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", [*GAS_FIELDS, "mesh", "time"])
def test_gas_fields_that_are_missing_or_cut_off_are_refused(tmp_path, ranks, name):
    write_gas(tmp_path / "gas", 0.5, ranks)
    check_gas(tmp_path / "gas", ranks, 0.5)
    last = tmp_path / "gas" / ("processor1" if ranks > 1 else "")
    if name == "time":
        shutil.move(last / "0.5", last / "0.4")
        with pytest.raises(DataError, match="has no fields of 0.5 s"):
            check_gas(tmp_path / "gas", ranks, 0.5)
        return
    file = last / "constant/polyMesh/faces" if name == "mesh" else last / "0.5" / name
    file.write_bytes(file.read_bytes()[:10])
    with pytest.raises(DataError, match=f"{file.name} is cut off"):
        check_gas(tmp_path / "gas", ranks, 0.5)
    file.unlink()
    if name != "mesh":
        with pytest.raises(DataError, match=f"{file.name} cannot be read"):
            check_gas(tmp_path / "gas", ranks, 0.5)


def test_a_series_that_does_not_reach_its_end_is_refused(tmp_path):
    file = tmp_path / "bed_series.csv"
    write_series(file, 0.1, 0.2, 0.01)
    check_series(file, (0.1, 0.2), 0.01)
    text = file.read_text()
    lines = text.splitlines(keepends=True)
    for damaged in (text[:-1], text[:-30], "".join(lines[:4] + lines[6:]), lines[0], "", "\0" * len(text)):
        file.write_text(damaged)
        with pytest.raises(DataError, match="bed_series.csv (is cut off|cannot be read)"):
            check_series(file, (0.1, 0.2), 0.01)


def test_what_a_solver_left_incomplete_is_said_with_the_disk_s_space(tmp_path):
    (tmp_path / "segment_0002.part").mkdir()
    with (
        pytest.raises(UserError, match="(?s)segment_0002 is not complete.*torn.*are free.*same command"),
        complete(tmp_path / "segment_0002.part"),
    ):
        raise DataError("frame_5.bin is torn")
