# SPDX-License-Identifier: GPL-3.0-or-later
"""All checks of a case, registered by the import of their modules, and the problems that they find."""

from typing import Any

from bedchain.case import bed_checks, chain_checks, gas_checks, scene_checks  # noqa: F401
from bedchain.case.check_registry import CHECKS
from bedchain.errors import Problem


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
    values = {key: value for key, value in case.items() if not isinstance(value, dict)}
    for section, group in case.items():
        if isinstance(group, dict):
            values |= {f"{section}.{key}": value for key, value in group.items()}
    refused = {key.split("[")[0] for key in broken}
    problems = []
    for keys, check in CHECKS:
        if all(key in values and key not in refused for key in keys):
            findings = check(*(values[key] for key in keys))
            problems += [Problem(key, wrong, remedy, lines.get(key)) for key, wrong, remedy in findings]
    return problems
