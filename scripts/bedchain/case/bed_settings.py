# SPDX-License-Identifier: GPL-3.0-or-later
"""Cheaper or dearer settings of a case's bed, as changes by dotted key."""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from bedchain.case.checks import physical_problems
from bedchain.case.scene_checks import checked_keys
from bedchain.case.schema import Case, with_values
from bedchain.errors import Problem
from bedchain.physics.whole_numbers import dividing_step

Changes = dict[str, Any]


def stiffness(case: Case, factor: float) -> Changes:
    """Young's modulus times a factor; the step goes with its root: its share of the Rayleigh time stays.

    Parameters
    ----------
    case : dict
    factor : float
    """
    young, step_s = case["contact"]["young_modulus_Pa"] * factor, case["time"]["dem_step_s"]
    shorter = dividing_step(coupling_s(case), step_s / math.sqrt(factor))
    return {"contact.young_modulus_Pa": young, "time.dem_step_s": shorter}


def dem_step(case: Case, factor: float) -> Changes:
    """The particles' step times a factor, or the next shorter one that divides gas step or frame interval."""
    return {"time.dem_step_s": dividing_step(coupling_s(case), case["time"]["dem_step_s"] * factor)}


def parcels(size: float) -> Changes:
    """Parcels of so many diameters."""
    return {"particles.parcel_diameters": size}


def gas_step(case: Case, factor: float) -> Changes:
    """Gas step times a factor, as near as frames allow; the particles' step is made to divide it."""
    time = case["time"]
    step_s = dividing_step(time["frame_interval_s"], time["gas_step_s"] * factor)
    return {"time.gas_step_s": step_s, "time.dem_step_s": dividing_step(step_s, time["dem_step_s"])}


def gas_cell(case: Case, factor: float) -> Changes:
    """Square gas cells that divide the bed, as near as possible to the case's times a factor."""
    width, height = (Fraction(repr(case["bed"][name])) for name in ("width_m", "height_m"))
    wanted = float(width) / (case["gas"]["cell_size_m"] * factor)
    least = (height / width).denominator  # columns must be a multiple of it for whole rows
    return {"gas.cell_size_m": float(width / (least * max(1, round(wanted / least))))}


def problems_with(case: Case, changes: Mapping[str, Any]) -> list[Problem]:
    """What keeps a checked case from being simulated with some changes; empty where nothing does."""
    return physical_problems(checked_keys(with_values(case, changes)), set(), {})


def coupling_s(case: Case) -> float:
    """Time that the particles' step must divide [s]: the gas step or, without gas, the frame interval."""
    time = case["time"]
    return float(time["frame_interval_s" if case["gas"]["model"] == "none" else "gas_step_s"])
