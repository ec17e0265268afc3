# SPDX-License-Identifier: GPL-3.0-or-later
"""The schema of a case, and the lookup of its keys and of a case's values."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from bedchain.case.strict_yaml import read_yaml

SCHEMA_FILE = Path(__file__).resolve().parents[3] / "cases" / "case.schema.yaml"
Case = dict[str, Any]
Schema = dict[str, Any]


@cache
def load_schema(file: Path = SCHEMA_FILE) -> Schema:
    """The schema of case files (JSON Schema 2020-12), read once; not to be changed."""
    schema, _ = read_yaml(file)
    return dict(schema)


def case_value(case: Case, key: str) -> Any:
    """The value of a dotted key, None where it or its section is missing."""
    value: Any = case
    for name in key.split("."):
        if not isinstance(value, dict) or name not in value:
            return None
        value = value[name]
    return value


def with_values(case: Case, values: Mapping[str, Any]) -> Case:
    """A case with other values of some dotted keys, whose sections are made where missing; a new dict."""
    for key, value in values.items():
        section, _, name = key.partition(".")
        case = case | {section: case.get(section, {}) | {name: value} if name else value}
    return case


def schema_keys(schema: Schema, section: str = "") -> dict[str, Schema]:
    """Dotted key -> its part of the schema, for all keys that hold a value, in the schema's order."""
    keys: dict[str, Schema] = {}
    for name, part in schema["properties"].items():
        path = f"{section}.{name}" if section else name
        keys |= schema_keys(part, path) if part.get("type") == "object" else {path: part}
    return keys
