# SPDX-License-Identifier: GPL-3.0-or-later
"""A drum's case: what it may hold, the numbers it hands on, and what is made of a series without gas."""

import re
from pathlib import Path

from bedchain.case.load import load_case
from bedchain.case.parameters import liggghts_text, solver_parameters
from bedchain.case.scene import scene_of
from bedchain.case.schema import load_schema
from bedchain.dem.drum import input_files
from bedchain.studies import audit
from bedchain.workflow import table_values
from made import ROOT

DRUM = ROOT / "cases" / "drum" / "case.yaml"


def test_the_drum_s_decks_get_every_number_that_they_ask_for():
    case = load_case(DRUM)
    given = set(re.findall(r"^variable (\w+) ", liggghts_text(solver_parameters(case, load_schema())), re.M))
    decks = input_files(Path("results/drum"), ROOT / "liggghts_inputs")[1:]
    text = "\n".join(deck.read_text(encoding="utf-8") for deck in decks)
    own = set(re.findall(r"^variable\s+(\w+)\s+(?:index|equal|atom)", text, re.M))
    assert set(re.findall(r"\$\{(\w+)\}", text)) <= given | own


def test_the_drum_needs_no_gas_and_table_1_shows_none_of_its_numerics():
    case = load_case(DRUM)
    rows = audit.audit(scene_of(case)).set_index("physics")
    assert rows.loc["gas flow", "decision"] == "drop" and rows.loc["gas flow", "built"] == "no"
    assert rows.loc["gas flow", "value"] < 0.05
    kept = set(rows.index[rows["decision"] == "keep"])
    assert "collisions" in kept and "particles act on the gas" not in kept
    # one layer stands for a slice of a long drum: real end walls would carry part of it
    assert set(rows.index[rows["agrees"] == "no"]) == {"friction in front and behind"}
    shown = table_values(case)
    assert shown["gas.model"] == "none" and shown["drum.revolution_s"] == 5.2
    unused = {"gas.cell_size_m", "gas.drag_law", "time.gas_step_s", "contact.largest_overlap_1"}
    assert not unused & set(shown) and unused <= set(table_values(load_case(ROOT / "cases/short/case.yaml")))
