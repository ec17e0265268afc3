# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of the verification table: which value is near enough."""

import math

import pytest

from bedchain.studies.verification.rows import Row, table_of


@pytest.mark.parametrize(
    ("value", "reference", "tolerance", "passes"),
    [
        (1.009, 1.0, 0.01, True),
        (1.011, 1.0, 0.01, False),
        (-0.98, -1.0, 0.01, False),
        (1e-13, 0.0, 1e-12, True),
        (2e-12, 0.0, 1e-12, False),
        (0.0, 0.0, 0.0, True),
        (math.nan, 1.0, 0.5, False),
        (math.inf, 1.0, math.inf, False),
    ],
)
def test_tolerance_is_relative_or_absolute_at_zero(value, reference, tolerance, passes):
    row = Row("something [1]", value, reference, tolerance, "made up")
    assert row.passed is passes
    assert table_of([row])["pass"].tolist() == ["yes" if passes else "no"]


def test_only_an_average_has_an_error():
    rows = [Row("mean [1]", 1.0, 1.0, 0.1, "made up", error=0.02), Row("count [1]", 1.0, 1.0, 0.1, "made up")]
    error = table_of(rows)["error"]
    assert error[0] == 0.02 and math.isnan(error[1])
