# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets, cases/presets.yaml: settings of chain and bed by name, with measured cost and error.

A preset is brought onto a case as nearly as its bed and windows allow. What it changes of the bed holds where
the bed is simulated: an archive and imported frames are what they are.
"""

import logging
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bedchain.case import bed_settings
from bedchain.case.checks import physical_problems
from bedchain.case.chosen import AUTO
from bedchain.case.names import NAME_RULE, is_name
from bedchain.case.scene_checks import checked_keys
from bedchain.case.schema import Case, load_schema, with_values
from bedchain.case.strict_yaml import Lines, read_yaml
from bedchain.errors import CaseError, UserError, guess
from bedchain.physics.whole_numbers import ratio

LOG = logging.getLogger(__name__)

PRESETS = Path("cases/presets.yaml")
MADE_BY = "snakemake tradeoff measures presets and writes results/<case>/presets.yaml"
SETTINGS = ("cell_m", "lag_s", "model")
# of the bed: Young's modulus and then the particles' step over the case's, diameters of a parcel. Not the gas
# step: twice the case's is stable on the short bed, not on the paper's.
BED_SETTINGS = ("young_modulus_times", "dem_step_times", "parcel_diameters")
MEASURED = ("cost_s", "error_floors")
OTHERS = ("density_floors", "measured_on")
FEWEST_CELLS = 4  # along each side of a bed: of fewer, half a bed is a single cell
LEVEL_DIAMETERS = 0.5  # an archive keeps positions to half a diameter: cells of whole levels are exact


@dataclass(frozen=True)
class Preset:
    """Settings of a chain and of its bed, and what was measured with them.

    Attributes
    ----------
    name : str
    cell_m, lag_s : float or "auto"
        Side of a cell [m], time of a step [s]; auto leaves it to choose_chain, from each bed's particles.
    model : str
        A name in `bedchain.models.LEARNERS`.
    cost_s : float
        To learn and to run the chain [s]; NaN where it is not given.
    error_floors : float
        Error of the mixing curves in noise floors [1]; NaN where it is not given.
    measured_on : str
        Bed and machine; empty where it is not given.
    bed : dict of str to float
        Those of `BED_SETTINGS` that it changes.
    """

    name: str
    cell_m: float | str
    lag_s: float | str
    model: str
    cost_s: float = math.nan
    error_floors: float = math.nan
    measured_on: str = ""
    bed: Mapping[str, float] = field(default_factory=dict)


def read_presets(file: Path = PRESETS) -> dict[str, Preset]:
    """The presets of a file, by name.

    Parameters
    ----------
    file : Path

    Returns
    -------
    dict of str to Preset
        Empty where there is no such file.

    Raises
    ------
    UserError
        A preset lacks a setting, or one is of the wrong kind.
    """
    if not file.exists():
        return {}
    content, lines = read_yaml(file)
    if not isinstance(content, dict):
        raise UserError(f"{file} holds no presets; {MADE_BY}")
    return {name: _preset(file, name, given, lines) for name, given in content.items()}


def preset_named(name: str, file: Path = PRESETS) -> Preset:
    """One preset.

    Parameters
    ----------
    name : str
    file : Path

    Returns
    -------
    Preset

    Raises
    ------
    UserError
        There is none of that name: with those that there are.
    """
    presets = read_presets(file)
    if not presets:
        raise UserError(f"there is no preset {name!r}: {file} holds no presets; {MADE_BY}")
    if name not in presets:
        known = ", ".join(presets)
        raise UserError(f"there is no preset {name!r} in {file}: take one of {known}{guess(name, presets)}")
    return presets[name]


def with_preset(case: Case, preset: Preset, file: Path = PRESETS) -> Case:
    """A case whose chains are those of a preset.

    Cells are as near to the preset's, or to a quarter of a small bed's shorter side, as divisors of the bed
    allow that keep a line between groups on a border of cells where the case has it on one; the lag is the
    nearest multiple of the frame interval.

    Parameters
    ----------
    case : dict
        A checked case.
    preset : Preset
    file : Path
        Where it is from, for messages.

    Returns
    -------
    dict
        A checked case; the given one is not changed.

    Raises
    ------
    CaseError
        The preset does not go with the case.
    """
    lag_s = preset.lag_s if isinstance(preset.lag_s, str) else _lag(case, preset.lag_s)
    bed, cells, lines, diameter = case["bed"], case["cells"], case["mixing"], case["particles"]["diameter_m"]
    own = [1 if cells[name] == AUTO else cells[name] for name in ("columns", "rows")]
    columns: int | str = AUTO
    rows: int | str = AUTO
    if not isinstance(preset.cell_m, str):
        cell_m = min(preset.cell_m, bed["width_m"] / FEWEST_CELLS, bed["height_m"] / FEWEST_CELLS)
        columns = count_near(bed["width_m"], cell_m, lines["split_x_m"], own[0], diameter)
        rows = count_near(bed["height_m"], cell_m, lines["split_z_m"], own[1], diameter)
    changed = case | {
        "cells": cells | {"columns": columns, "rows": rows},
        "chain": case["chain"] | {"lag_s": lag_s, "models": [preset.model]},
    }
    if problems := physical_problems(checked_keys(changed), set(), {}):
        raise CaseError(f"{file}, {preset.name} on {case['title']}", problems)
    return changed


def with_preset_bed(case: Case, preset: Preset) -> Case:
    """A case whose bed is simulated as a preset says, as far as the case allows: what it does not is logged.

    Parameters
    ----------
    case : dict
        A checked case of a simulated bed.
    preset : Preset

    Returns
    -------
    dict
        A checked case; the given one where the preset leaves the bed alone.
    """
    for setting, value in preset.bed.items():
        if setting == "young_modulus_times":
            changes = bed_settings.stiffness(case, value)
        elif setting == "dem_step_times":
            changes = bed_settings.dem_step(case, value)
        elif case["gas"]["model"] != "none":
            changes = bed_settings.parcels(value)
        else:
            continue
        if problems := bed_settings.problems_with(case, changes):
            LOG.warning("preset %s leaves out %s %g: %s", preset.name, setting, value, problems[0].wrong)
        else:
            case = with_values(case, changes)
    return case


def simulated_case(case: Case, preset: str | None, reference: Path | None) -> Case:
    """The case with the bed of its preset, where there is one and the bed is simulated; else the case itself.

    Parameters
    ----------
    case : dict
        A checked case, with the chains of the preset.
    preset : str, optional
        Its name; by default that of the case's key ``preset``, if any.
    reference : Path, optional
        The archive that the bed is taken from.
    """
    preset = preset or case.get("preset")
    if not preset or reference or "frames" in case:
        return case
    return with_preset_bed(case, preset_named(preset))


def _preset(file: Path, name: str, given: Any, lines: Lines) -> Preset:
    if not isinstance(given, dict):
        place = f"{file}, line {lines[name]}, {name}"
        raise UserError(f"{place}: {given!r} is no preset, which has {', '.join(SETTINGS)}; {MADE_BY}")
    if not is_name(name):
        raise UserError(f"{file}, line {lines[name]}: the name of the preset {name!r} must have {NAME_RULE}")
    known = load_schema()["properties"]["chain"]["properties"]["models"]["items"]["enum"]
    for key in dict.fromkeys((*SETTINGS, *given)):
        place = f"{file}, line {lines.get(f'{name}.{key}', lines[name])}, {name}"
        _check_setting(place, key, given.get(key), known)
    measured = {key: float(given[key]) for key in MEASURED if key in given}
    about = str(given.get("measured_on", ""))
    cell_m, lag_s = (given[key] if given[key] == AUTO else float(given[key]) for key in SETTINGS[:2])
    bed = {key: float(given[key]) for key in BED_SETTINGS if key in given}
    return Preset(name, cell_m, lag_s, given["model"], **measured, measured_on=about, bed=bed)


def _check_setting(place: str, key: str, value: Any, models: list[str]) -> None:
    keys = (*SETTINGS, *BED_SETTINGS, *MEASURED, *OTHERS)
    if key not in keys:
        raise UserError(f"{place}: {key} is an unknown key{guess(key, keys)}; known are {', '.join(keys)}")
    if key in OTHERS or (key in SETTINGS[:2] and value == AUTO):
        return
    if value in models if key == "model" else is_positive(value):
        return
    wanted = f"one of {', '.join(models)}" if key == "model" else "a number above 0"
    raise UserError(f"{place}: {key} is {value!r}, not {wanted}; {MADE_BY}")


def is_positive(value: Any) -> bool:
    """Whether a value of a file is a number above 0."""
    return isinstance(value, int | float) and not isinstance(value, bool) and value > 0


def count_near(length_m: float, wanted_m: float, line_m: float, own: int, diameter_m: float) -> int:
    """Cells along one side of the bed whose size is as near as may be to the one wanted, by its logarithm.

    Parameters
    ----------
    length_m, wanted_m : float
        Of the bed and of a cell [m].
    line_m : float
        Line between two groups [m]: where it is a border of the case's own cells, it stays one.
    own : int
        Cells of the case [1].
    diameter_m : float
        Of a particle: no cell is smaller; where half of it divides the bed, each cell is whole halves [m].

    Returns
    -------
    int
    """
    levels, border = ratio(length_m, LEVEL_DIAMETERS * diameter_m), ratio(line_m, length_m)
    kept = (border * own).denominator == 1
    counts: list[int] = [
        count
        for count in range(1, int(ratio(length_m, diameter_m)) + 1)
        if (levels.denominator > 1 or levels % count == 0) and not (kept and (border * count).denominator > 1)
    ]
    return min(counts or [own], key=lambda count: abs(math.log(length_m / count / wanted_m)))


def _lag(case: Case, wanted_s: float) -> float:
    """Time of a step, a multiple of the frame interval and at most a window [s]."""
    interval_s = case["time"]["frame_interval_s"]
    lengths = [
        ratio(case[name]["end_s"], interval_s) - ratio(case[name]["start_s"], interval_s)
        for name in ("learning", "comparison")
    ]
    frames = min(max(1, round(wanted_s / interval_s)), max(1, int(min(lengths))))
    return float(frames * ratio(interval_s, 1.0))
