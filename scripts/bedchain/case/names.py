# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of cases and presets: they become parts of file names, of rules and of shell lines, as they are."""

import re
from collections.abc import Collection

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9._-]*\Z")
NAME_RULE = "letters, digits, '.', '_' and '-' only, and no '.' or '-' at its start"
# folders of results that are no case's
RESERVED = {
    "bands": "the study of error bars",
    "benchmark_core": "the benchmark of the Markov core",
    "bin": "the solver",
    "peers": "the study peers",
    "stability": "the study stability",
    "verify": "the study verify",
}


def is_name(text: str) -> bool:
    """Whether a text may be the name of a case or a preset: nothing in it means anything to a shell."""
    return NAME.match(text) is not None


def case_name_problem(name: str, cases: Collection[str], presets: Collection[str]) -> str | None:
    """Why a folder of cases/ cannot be run under its name, in one line; None where it can.

    Parameters
    ----------
    name : str
        Of the folder.
    cases, presets : collection of str
        All that there are.

    Returns
    -------
    str or None
    """
    if not is_name(name):
        return f"the name of the case {name!r} must have {NAME_RULE}: rename its folder in cases/"
    if name in RESERVED:
        return f"results/{name} belongs to {RESERVED[name]}: rename the folder cases/{name}"
    for case in cases:
        preset = name.removeprefix(f"{case}-")
        if name.startswith(f"{case}-") and preset in presets:
            owner = f"the case {case} with the preset {preset}"
            return f"results/{name} belongs to {owner}: rename the folder cases/{name}"
    return None
