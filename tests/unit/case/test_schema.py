# SPDX-License-Identifier: GPL-3.0-or-later
"""The schema of case files: every key explained, no unknown key let in."""

import re

from jsonschema import Draft202012Validator

from bedchain.case.schema import load_schema, schema_keys


def test_the_schema_is_one():
    Draft202012Validator.check_schema(load_schema())


def test_every_key_of_the_schema_says_meaning_unit_and_source():
    for key, part in schema_keys(load_schema()).items():
        description = part["description"]
        assert re.search(r"\[[^\]]+\]", description), f"{key}: no [unit]"
        source = "Table 1|[Ss]ection|Our choice|[Oo]ur choice|paper|Figs"
        # the section of the frames says of all its keys that they are our choice
        assert key.startswith("frames.") or re.search(source, description), f"{key}: no source"


def test_every_object_of_the_schema_refuses_unknown_keys():
    def walk(part):
        if part.get("type") == "object":
            assert part["additionalProperties"] is False
            for inner in part["properties"].values():
                walk(inner)

    walk(load_schema())
