# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a case: the same bed with some keys changed, each simulated in a folder of its own."""

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from bedchain.case import Case, load_case
from bedchain.solver_process import run_logged
from bedchain.stage import complete
from bedchain.yaml_file import read_yaml


@dataclass(frozen=True)
class Variant:
    """A case with some keys changed.

    Attributes
    ----------
    name : str
        Of its folder.
    changes : mapping of str to object
        New values by dotted key, such as ``{"gas.drag_law": "beetstra"}``.
    """

    name: str
    changes: Mapping[str, Any] = field(default_factory=dict)


def write_variant(case_file: Path, variant: Variant, folder: Path) -> Case:
    """Write the case file of a variant.

    Parameters
    ----------
    case_file : Path
        The case that it varies.
    variant : Variant
    folder : Path
        Gets ``case.yaml``; made where missing.

    Returns
    -------
    dict
        The variant's checked case.

    Raises
    ------
    CaseError
        The variant cannot be run: with every reason.
    """
    content = dict(read_yaml(case_file)[0])
    for key, value in variant.changes.items():
        section, _, name = key.partition(".")
        content[section] = content.get(section, {}) | {name: value} if name else value
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "case.yaml"
    with complete(file) as temporary:
        temporary.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    return load_case(file)


def simulate(case_file: Path, variant: Variant, folder: Path, ranks: int = 1) -> Case:
    """Simulate a variant to its end, or go on from the last finished segment of an earlier try.

    Parameters
    ----------
    case_file : Path
        The case that it varies.
    variant : Variant
    folder : Path
        Gets what ``results/<case>`` of a simulated case holds: ``dem.json``, ``bed_series.csv``, ``dem/``.
    ranks : int
        MPI ranks.

    Returns
    -------
    dict
        The variant's checked case.

    Raises
    ------
    UserError
        It cannot be run, or its solvers stopped: why, in their own words.
    """
    case = write_variant(case_file, variant, folder)
    times = {"--end": case["time"]["end_s"], "--segment": case["time"]["segment_s"], "--ranks": ranks}
    options = [str(word) for option in times.items() for word in option]
    log = folder / "simulate.log"
    log.unlink(missing_ok=True)
    for script, arguments in (
        ("write_parameters", [os.fspath(folder / "case.yaml"), os.fspath(folder)]),
        ("run_dem", [os.fspath(folder), *options]),
    ):
        run_logged([sys.executable, f"scripts/{script}.py", *arguments], log)
    return case
