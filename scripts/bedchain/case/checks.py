# SPDX-License-Identifier: GPL-3.0-or-later
"""All checks of a case, registered by the import of their modules, and the problems that they find."""

from typing import Any

from bedchain.case import (  # noqa: F401
    bed_checks,
    cell_checks,
    chain_checks,
    frame_checks,
    gas_checks,
    mark_checks,
    network_checks,
    parcel_checks,
    rank_checks,
    scene_checks,
    size_checks,
    stage_checks,
)
from bedchain.case.check_registry import CHECKS
from bedchain.case.chosen import AUTO
from bedchain.errors import Problem

# where a case says nothing of it
FORM_OF_CELLS = {"cells.form": "boxes", "cells.axis": "vertical", "cells.layers": 1}


def physical_problems(case: dict[str, Any], broken: set[str], lines: dict[str, int]) -> list[Problem]:
    """Problems that the checks find; a check whose keys are missing or already refused is left out.

    Parameters
    ----------
    case : dict
        The case with its defaults.
    broken : set of str
        Dotted keys that the schema refused.
    lines : dict of str to int
        Dotted key -> line in the file.
    """
    values = FORM_OF_CELLS | _by_dotted_key(case)
    refused = {key.split("[")[0] for key in broken}
    problems = []
    for keys, check in CHECKS:
        if all(key in values and key not in refused for key in keys):
            given = [values[key] for key in keys]
            findings = () if AUTO in given else check(*given)  # what a rule chooses later cannot be wrong
            problems += [Problem(key, wrong, remedy, lines.get(key)) for key, wrong, remedy in findings]
    return problems


def _by_dotted_key(group: dict[str, Any], path: str = "") -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, value in group.items():
        key = f"{path}.{name}" if path else name
        values |= _by_dotted_key(value, key) if isinstance(value, dict) else {key: value}
    return values
