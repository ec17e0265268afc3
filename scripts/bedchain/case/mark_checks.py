# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the marks: names of their own, and one rule each."""

from collections.abc import Iterator
from typing import Any

from bedchain.case.check_registry import Finding, reads

RULES = ("plane", "ring", "types", "diameter_below_m", "ids")


@reads("marks")
def marks_have_one_rule(marks: list[dict[str, Any]]) -> Iterator[Finding]:
    """Refuse a mark with no rule or several, a plane without a direction, and two marks of one name."""
    names = [mark["name"] for mark in marks]
    for mark in marks:
        rules = [rule for rule in RULES if rule in mark]
        if len(rules) != 1:
            given = " and ".join(rules) or "no rule"
            yield "marks", f"{mark['name']} has {given}", f"give it one of {', '.join(RULES)}"
        if "plane" in mark and not any(mark["plane"]["normal"]):
            yield (
                "marks",
                f"{mark['name']} has a plane of normal 0, 0, 0",
                "give it a direction, such as [1, 0, 0]",
            )
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield "marks", f"{names.count(name)} marks are called {name}", "give each a name of its own"
