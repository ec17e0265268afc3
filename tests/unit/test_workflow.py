# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of a case as rules of the Snakefile take them."""

import subprocess
import sys

import pytest

from bedchain.case.load import load_case
from bedchain.workflow import pick, table_values
from made import ROOT


def test_keys_are_picked_by_their_last_name():
    case = {"bed": {"width_m": 0.1, "height_m": 0.2}, "cells": {"rows": 2, "width_m": 3}}
    assert pick(case, "bed.width_m") == {"width_m": 0.1}
    assert pick(case, "bed.height_m", "cells") == {"height_m": 0.2, "rows": 2, "width_m": 3}
    with pytest.raises(KeyError, match="width_m is picked twice"):
        pick(case, "bed.width_m", "cells")
    with pytest.raises(KeyError):
        pick(case, "bed.depth_m")


def test_table_values_are_of_sections_in_use_and_models_built():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    values = table_values(case)
    assert values["bed.width_m"] == case["bed"]["width_m"] and "title" not in values
    assert not any(key.startswith(("figures.", "drum.", "chain.jump.")) for key in values)


def test_snakemake_starts_without_the_packages_that_compute():
    """They take more than a second of every start, also of ``--dry-run``."""
    line = (
        "import sys, bedchain.workflow; print(sorted({'numba', 'scipy', 'matplotlib'} & sys.modules.keys()))"
    )
    program = [sys.executable, "-c", line]
    ended = subprocess.run(program, cwd=ROOT / "scripts", capture_output=True, text=True, check=True)
    assert ended.stdout == "[]\n"
