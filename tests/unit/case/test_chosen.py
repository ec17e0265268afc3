# SPDX-License-Identifier: GPL-3.0-or-later
"""choice.csv: what choose_chain writes is read, what is damaged is named."""

import pytest

from bedchain.case.chosen import Chosen, read_choice
from bedchain.errors import UserError

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
