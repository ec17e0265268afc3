# SPDX-License-Identifier: GPL-3.0-or-later
"""A case that is a network: its own sections only, and one model a chain."""

import re

import pytest

from bedchain.case.load import load_case
from bedchain.case.network_checks import network_schema
from bedchain.case.schema import load_schema
from bedchain.errors import CaseError

CHAIN = "    - {name: r, riser_steps: {cells: 3, to_annulus_1: 0.1, to_core_1: 0.2}}\n"
EDGES = "edges: {states: [{name: a}], moves: [{from: a, to: a, probability_1: 1}]}"
PAGE = "title: t\nnetwork:\n  chains:\n" + CHAIN


def problems(tmp_path, text):
    (tmp_path / "case.yaml").write_text(text)
    with pytest.raises(CaseError) as error:
        load_case(tmp_path / "case.yaml")
    return str(error.value)


def test_defaults_are_filled_in_within_lists(tmp_path):
    (tmp_path / "case.yaml").write_text(PAGE)
    case = load_case(tmp_path / "case.yaml")
    assert case["network"]["chains"][0]["riser_steps"]["refluxed_1"] == 0
    assert case["figures"] == {"resolution_dpi": 200} and "gas" not in case


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PAGE + "bed: {width_m: 1, height_m: 1}\n", "line 5, bed: belongs to a bed of particles"),
        (PAGE + "frames: {files: a}\n", "line 5, frames: belongs"),
        (PAGE + "bedd: 1\n", "bedd: is an unknown key"),
        (PAGE.replace("cells: 3", "cels: 3"), r"line 4, network.chains\[0\].riser_steps"),
        (PAGE.replace("cells: 3", "cels: 3"), r"cels: is an unknown key; did you mean cells"),
        (PAGE.replace("cells: 3", "cells: 0"),
         r"line 4, network.chains\[0\].riser_steps.cells: 0 is not at least 1"),
        (PAGE.replace("0.1", "x"), "'x' is not a number"),
        (PAGE + "    - {name: s}\n", "s has no model"),
        (PAGE + CHAIN, "2 chains are called r"),
        (PAGE.replace("name: r,", f"name: r, {EDGES},"), "edges and riser_steps"),
        ("title: t\nnetwork: {}\n", "network.chains: is missing"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_named_with_its_line(tmp_path, text, message):
    assert re.search(message, problems(tmp_path, text)), problems(tmp_path, text)


def test_the_schema_of_a_network_is_as_strict_as_that_of_a_bed():
    def walk(part):
        if part.get("type") == "object" and "properties" in part:
            assert part["additionalProperties"] is False
            for inner in part["properties"].values():
                walk(inner)
        if part.get("type") in ("number", "integer"):
            assert {"minimum", "exclusiveMinimum"} & part.keys(), part
            assert {"maximum", "exclusiveMaximum"} & part.keys(), part
        if "items" in part:
            walk(part["items"])
        assert part.get("type") != "object" or "additionalProperties" in part

    walk(network_schema(load_schema()))
