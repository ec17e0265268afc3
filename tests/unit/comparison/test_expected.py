# SPDX-License-Identifier: GPL-3.0-or-later
"""Expected values against measured ones."""

import pandas as pd
import pytest

from bedchain.comparison.expected import deviations, read_expected
from bedchain.errors import UserError

HEADER = "quantity,source,value,tolerance,unit\n"
METRICS = pd.DataFrame(
    {
        "quantity": ["height", "height", "drop"],
        "source": ["dem", "static", "dem"],
        "value": [0.1, 0.12, float("nan")],
        "unit": ["m", "m", "Pa"],
    }
)


def expected(tmp_path, rows):
    file = tmp_path / "expected.csv"
    file.write_text(HEADER + rows, encoding="utf-8")
    return read_expected(file)


def test_values_inside_their_tolerance_pass(tmp_path):
    rows = "# measured three times\nheight,dem,0.11,0.011,m\nheight,static,0.12,0.001,m\n"
    assert deviations(expected(tmp_path, rows), METRICS) == []


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("height,dem,0.11,0.009,m\n", "height of dem [m] is 0.1, expected 0.11 +- 0.009"),
        ("height,dem,0.1,0.1,mm\n", "height of dem [mm] is nan, expected 0.1 +- 0.1"),
        ("height,dynamic,0.1,0.1,m\n", "height of dynamic [m] is nan, expected 0.1 +- 0.1"),
        ("drop,dem,500,1e9,Pa\n", "drop of dem [Pa] is nan, expected 500 +- 1e+09"),
    ],
)
def test_what_is_off_or_absent_is_named(tmp_path, row, said):
    assert deviations(expected(tmp_path, row), METRICS) == [said]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("height,dem,0.1,0,m\n", "a tolerance is not positive"),
        ("height,dem,0.1,1,m\nheight,dem,0.2,1,m\n", "height of dem is there twice"),
    ],
)
def test_a_bad_table_is_refused(tmp_path, rows, said):
    with pytest.raises(UserError, match=said):
        expected(tmp_path, rows)


def test_a_missing_column_is_refused(tmp_path):
    file = tmp_path / "expected.csv"
    file.write_text("quantity,source,value\n", encoding="utf-8")
    with pytest.raises(UserError, match="lacks the columns tolerance, unit"):
        read_expected(file)


def test_a_comma_too_many_is_told_with_its_line(tmp_path):
    with pytest.raises(UserError, match="line 3.*put texts with a comma into quotes"):
        expected(tmp_path, "height,dem,0.11,0.011,m\nheight,static,0.12,0.001,m,one, two\n")
