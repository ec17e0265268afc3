# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1: the values of a case beside the paper's."""

from bedchain.case.schema import load_schema
from bedchain.comparison.table1 import table_of_values


def test_values_stand_beside_the_paper_s_and_others_are_left_out():
    values = {"particles.number": 9000, "particles.diameter_m": 1e-3, "figures.moments_s": [0.05, 0.3]}
    table = table_of_values(values, load_schema()).set_index("key")
    assert set(table.index) == set(values)
    assert table.loc["particles.number", ["value", "paper_value"]].tolist() == ["9000", "81000"]
    assert table.loc["particles.diameter_m", "value"] == "0.001"
    assert table.loc["figures.moments_s", "value"] == "0.05 0.3"
    assert table["meaning"].str.contains(r"\[.+\]").all()
