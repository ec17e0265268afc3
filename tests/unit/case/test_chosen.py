# SPDX-License-Identifier: GPL-3.0-or-later
"""choice.csv: what choose_chain writes is read, what is damaged is named."""

import pytest

from bedchain.case.chosen import AUTO, Chosen, is_auto, read_choice, with_choice
from bedchain.case.load import load_case
from bedchain.errors import CaseError, UserError
from made.case_text import changed_case

TABLE = 'quantity,value,unit,why\nlag_s,0.325,s,"first, and only"\ncolumns,9,1,wide\nrows,35,1,high\n'


def test_lag_and_cells_are_read(tmp_path):
    file = tmp_path / "choice.csv"
    file.write_text(TABLE)
    assert read_choice(file) == Chosen(0.325, 9, 35)


@pytest.mark.parametrize("text", ["", TABLE.replace("rows", "other"), TABLE.replace("0.325", "long")])
def test_a_damaged_table_is_named(tmp_path, text):
    file = tmp_path / "choice.csv"
    file.write_text(text)
    with pytest.raises(UserError, match="choice.csv gives no lag_s, columns, rows"):
        read_choice(file)


CELLS = "cells:\n  columns: 10\n  rows: 50\n"


@pytest.mark.parametrize("cells", ["", "cells: auto\n", "cells: {columns: auto}\n"])
def test_a_case_may_leave_lag_and_cells_to_the_rule(tmp_path, cells):
    case = load_case(changed_case(tmp_path, (CELLS, cells)))
    assert is_auto(case) and case["chain"]["lag_s"] == AUTO == case["cells"]["rows"]
    with pytest.raises(FileNotFoundError):
        with_choice(case, tmp_path / "choice.csv")
    (tmp_path / "choice.csv").write_text(TABLE)
    settled = with_choice(case, tmp_path / "choice.csv")
    assert (settled["chain"]["lag_s"], settled["cells"]["columns"], settled["cells"]["rows"]) == (
        0.325,
        9,
        35,
    )
    assert case["chain"]["lag_s"] == AUTO and not is_auto(settled)


def test_numbers_of_a_case_stay(tmp_path):
    case = load_case(changed_case(tmp_path, (CELLS, CELLS + "chain: {lag_s: 1}\n")))
    assert with_choice(case, tmp_path / "none") is case and case["chain"]["lag_s"] == 1.0
    half = load_case(changed_case(tmp_path, (CELLS, CELLS + "chain: {lag_s: auto}\n")))
    (tmp_path / "choice.csv").write_text(TABLE)
    assert with_choice(half, tmp_path / "choice.csv")["cells"]["columns"] == 10


@pytest.mark.parametrize("value", ["fast", "'0.025'", "Auto"])
def test_another_word_is_refused(tmp_path, value):
    with pytest.raises(CaseError, match="is not a number, and not auto"):
        load_case(changed_case(tmp_path, (CELLS, CELLS + f"chain: {{lag_s: {value}}}\n")))
