# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's error in one message without a traceback; other errors untouched."""

import errno

import pytest

from bedchain.errors import UserError, report_user_errors, world_error


def test_a_user_error_is_one_message_and_exit_code_1(capsys, tmp_path):
    with pytest.raises(SystemExit) as caught, report_user_errors(tmp_path / "log"):
        raise UserError("the disk is full; free some space")
    assert caught.value.code == 1
    assert capsys.readouterr().err == "error: the disk is full; free some space\n"
    assert (tmp_path / "log").read_text(encoding="utf-8") == "error: the disk is full; free some space\n"


def test_other_errors_pass_unchanged():
    with pytest.raises(ZeroDivisionError), report_user_errors():
        raise ZeroDivisionError


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (
            OSError(errno.ENOSPC, "x", "a.csv"),
            "a.csv: no space is left on its disk; free some space",
        ),
        (PermissionError(errno.EACCES, "x", "a.csv"), "a.csv: permission is denied; give yourself the right"),
        (
            IsADirectoryError(errno.EISDIR, "x", "a.csv"),
            "a.csv: a folder stands in its place; move",
        ),
        (FileNotFoundError(errno.ENOENT, "x", "a.csv"), "a.csv: it is missing; "),
        (OSError(errno.ENOSPC, "x"), "a file (its name is not known): no space is left"),
    ],
)
def test_an_error_of_the_world_is_a_sentence(capsys, error, message):
    with pytest.raises(SystemExit) as caught, report_user_errors():
        raise error
    assert caught.value.code == 1 and capsys.readouterr().err.startswith(f"error: {message}")


def test_an_error_of_the_world_that_is_none_keeps_its_traceback():
    assert world_error(OSError("no number")) is None
    with pytest.raises(ChildProcessError), report_user_errors():
        raise ChildProcessError(errno.ECHILD, "x")


def test_ctrl_c_leaves_no_traceback(capsys):
    with pytest.raises(SystemExit) as caught, report_user_errors():
        raise KeyboardInterrupt
    assert caught.value.code == 130 and capsys.readouterr().err.startswith("ended on request")
