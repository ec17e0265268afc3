# SPDX-License-Identifier: GPL-3.0-or-later
"""What a stage leaves behind when all goes well, and when it does not."""

import pandas as pd
import pytest

from bedchain.errors import DataError, UserError
from bedchain.files import complete, write_csv
from bedchain.stage import LOG, stage


@pytest.mark.parametrize("kind", [UserError, DataError])
def test_bad_input_is_one_line_and_no_traceback(tmp_path, capsys, kind):
    with pytest.raises(SystemExit) as ended, stage(tmp_path / "logs" / "a.log"):
        raise kind("frame 3 of a.bin is cut off: rerun segment 2")
    assert ended.value.code == 1
    message = "error: frame 3 of a.bin is cut off: rerun segment 2\n"
    assert capsys.readouterr().err == message
    assert (tmp_path / "logs" / "a.log").read_text() == message


def test_defect_keeps_its_traceback_in_the_log(tmp_path):
    with pytest.raises(ZeroDivisionError), stage(tmp_path / "a.log"):
        _ = 1 / 0
    assert "ZeroDivisionError" in (tmp_path / "a.log").read_text()


def test_reports_go_to_the_log_of_their_stage_only(tmp_path):
    for name in ("a", "b"):
        with stage(tmp_path / f"{name}.log"):
            LOG.info("this is %s", name)
    assert "this is a" in (tmp_path / "a.log").read_text()
    assert "this is a" not in (tmp_path / "b.log").read_text()


def test_file_appears_only_when_it_is_complete(tmp_path):
    target = tmp_path / "made" / "table.csv"
    with complete(target) as temporary:
        temporary.write_text("x")
        assert temporary.suffix == ".csv"
        assert not target.exists()
    assert [path.name for path in target.parent.iterdir()] == ["table.csv"]


def test_failure_leaves_what_was_there_before(tmp_path):
    target = tmp_path / "table.csv"
    target.write_text("before")
    with pytest.raises(RuntimeError), complete(target) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert target.read_text() == "before"
    assert list(tmp_path.iterdir()) == [target]


def test_csv_keeps_eight_digits(tmp_path):
    write_csv(pd.DataFrame({"a_m": [1 / 3, 2e-7], "b": ["x", "y"]}), tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text() == "a_m,b\n0.33333333,x\n2e-07,y\n"
