# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1: the values that matter, the paper's beside them in its own bed only."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema
from bedchain.comparison.table1 import ROWS, table_of_values
from bedchain.workflow import table_values
from made import ROOT


def table(case, with_paper=False):
    values = table_values(load_case(ROOT / "cases" / case / "case.yaml"))
    return table_of_values(values, load_schema(), with_paper).set_index("parameter")


def test_the_paper_s_values_stand_beside_its_bed():
    rows = table("paper", with_paper=True)
    assert len(rows) == 15
    assert rows.loc["bed, width x height", ["paper", "this_case"]].tolist() == ["0.27 x 1.05"] * 2
    assert rows.loc["chains learned from", ["paper", "this_case"]].tolist() == ["10 to 15"] * 2
    assert rows.loc["drag law", ["paper", "this_case"]].tolist() == ["not given", "gidaspow"]


@pytest.mark.parametrize(
    ("case", "there", "absent"),
    [
        ("short", {"drag law"}, {"time of a revolution", "bed, depth between the walls"}),
        ("drum", {"time of a revolution"}, {"drag law", "gas velocity over the empty section"}),
        ("mueller", {"bed, depth between the walls"}, {"time of a revolution"}),
    ],
)
def test_other_beds_have_what_they_use_and_nothing_of_the_paper(case, there, absent):
    rows = table(case)
    assert "paper" not in rows.columns
    assert there <= {*rows.index} and not absent & {*rows.index}


def test_a_bed_of_frames_has_a_depth_and_no_layers():
    values = table_values(load_case(ROOT / "cases" / "short" / "case.yaml"))
    rows = table_of_values(
        {key: value for key, value in values.items() if key != "bed.layers"}, load_schema(), False
    )
    assert "bed, depth between the walls" in {*rows["parameter"]}


def test_every_key_is_in_the_schema():
    known = table("short").shape and load_schema()["properties"]
    for row in ROWS:
        for key in row.keys:
            section, name = key.split(".")
            assert name in known[section]["properties"], key
