# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's error in one message without a traceback; other errors untouched."""

import pytest

from bedchain.errors import UserError, report_user_errors


def test_a_user_error_is_one_message_and_exit_code_1(capsys, tmp_path):
    with pytest.raises(SystemExit) as caught, report_user_errors(tmp_path / "log"):
        raise UserError("the disk is full; free some space")
    assert caught.value.code == 1
    assert capsys.readouterr().err == "error: the disk is full; free some space\n"
    assert (tmp_path / "log").read_text(encoding="utf-8") == "error: the disk is full; free some space\n"


def test_other_errors_pass_unchanged():
    with pytest.raises(ZeroDivisionError), report_user_errors():
        raise ZeroDivisionError
