# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiny beds of the stability study as case files, alike except for the values that a setting changes."""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from bedchain.case.scene import scene_of
from bedchain.physics.contacts import rayleigh_time
from bedchain.physics.scene_numbers import Scene
from bedchain.physics.whole_numbers import nearest_multiple, ratio

DIAMETER, DENSITY, YOUNG = 1e-3, 2600.0, 1.9e6  # of the paper and the schema; other beds are scaled
GAS_DENSITY, VISCOSITY, POISSON, FRICTION = 1.2, 1.8e-5, 0.3, 0.1
USUAL_SHARE = 0.18  # of the Rayleigh time
FRAME, SETTLE, RUN, RAMP = 4e-3, 0.15, 0.06, 0.02  # [s], of particles of 1 mm; times go with sqrt(d / g)
GAS_STEP = 5e-4  # [s], likewise
SMOOTHING = 3.0  # of the voidage, in diameters; the schema's
FEWEST_FRAMES = 8  # two windows of four
FEWEST_GAS_STEPS = 80  # bed_series.csv has a row for ten of them
SPLIT_DIAMETERS = 10  # height of lines that a case must have; the study does not use them


@dataclass(frozen=True)
class StabilityBed:
    """A bed of one layer in a box; lengths other than the diameter are in diameters.

    Attributes
    ----------
    diameter, density, number
        Of the particles [m], [kg/m3], [1].
    young : float, optional
        [Pa]; by default with the relative overlap of the paper's particles, ``E ~ rho g d``.
    width, height, thickness, cell : float
        Of the bed and its gas cells, in diameters.
    velocity : float
        Superficial [m/s].
    dem_step, gas_step : float, optional
        [s], that of the gas rounded to a whole number of the particles'; by default from the usual share of
        the Rayleigh time.
    run, settle : float
        Simulated times [s], of particles of 1 mm.
    allowed : bool
        `time.allow_unstable_step`.
    ranks : int
    more : dict
        Further keys by section.
    """

    diameter: float = DIAMETER
    density: float = DENSITY
    number: int = 300
    young: float | None = None
    width: int = 20
    height: int = 60
    thickness: float = 1.0
    cell: int = 5
    velocity: float = 0.0
    dem_step: float | None = None
    gas_step: float | None = None
    run: float = RUN
    settle: float = SETTLE
    allowed: bool = False
    ranks: int = 1
    more: dict[str, dict[str, Any]] = field(default_factory=dict)

    @property
    def stiffness(self) -> float:
        """Young's modulus [Pa]."""
        return self.young or YOUNG * (self.diameter / DIAMETER) * (self.density / DENSITY)

    @property
    def slowness(self) -> float:
        """Times of this bed over those of particles of 1 mm [1]."""
        return math.sqrt(self.diameter / DIAMETER)


def times(length: float, number: float) -> float:
    """``length * number``, exact for numbers as they are written in a file."""
    return float(Fraction(repr(length)) * Fraction(repr(number)))


def two_digits(value: float) -> float:
    """A positive value with two digits, never above it: short enough that its multiples are exact."""
    exponent = math.floor(math.log10(value)) - 1
    digits = math.floor(value / 10.0**exponent + 1e-9)
    return float(Fraction(digits) * Fraction(10) ** exponent)


def clock(bed: StabilityBed) -> dict[str, Any]:
    """Section `time` of a bed; each time is a whole number of the steps that divide it."""
    gas = bed.gas_step or GAS_STEP * bed.slowness
    usual = USUAL_SHARE * rayleigh_time(bed.stiffness, POISSON, bed.density, bed.diameter / 2)
    dem = bed.dem_step or two_digits(min(usual, gas))
    gas = nearest_multiple(gas, dem)
    frame = nearest_multiple(FRAME * bed.slowness, gas)
    wanted = max(bed.run * bed.slowness, FEWEST_GAS_STEPS * gas)
    frames = max(FEWEST_FRAMES, math.ceil(wanted / frame))
    frames += frames % 2
    end = times(frame, frames)
    return {
        "dem_step_s": dem, "gas_step_s": gas, "frame_interval_s": frame, "segment_s": end, "end_s": end,
        "settle_s": nearest_multiple(bed.settle * bed.slowness, dem), "ramp_s": RAMP * bed.slowness,
        "allow_unstable_step": bed.allowed,
    }  # fmt: skip


def case_of(bed: StabilityBed) -> dict[str, Any]:
    """Content of the case file of a bed."""
    time = clock(bed)
    frame, end = time["frame_interval_s"], time["end_s"]
    middle = times(frame, int(ratio(end, frame)) // 2)
    low = times(bed.diameter, SPLIT_DIAMETERS)
    case: dict[str, Any] = {
        "title": "bed of the stability study",
        "seed": 10007,
        "bed": {
            "width_m": times(bed.diameter, bed.width),
            "height_m": times(bed.diameter, bed.height),
            "thickness_m": times(bed.diameter, bed.thickness),
        },
        "particles": {
            "number": bed.number, "diameter_m": bed.diameter, "density_kg_m3": bed.density,
        },
        "contact": {
            "young_modulus_Pa": bed.stiffness, "poisson_ratio_1": POISSON, "friction_1": FRICTION,
            "rolling_friction_1": 0.0,
        },
        "gas": {
            "density_kg_m3": GAS_DENSITY, "viscosity_Pa_s": VISCOSITY,
            "superficial_velocity_m_s": bed.velocity, "cell_size_m": times(bed.diameter, bed.cell),
        },
        "time": time,
        "run": {"ranks": bed.ranks},
        "learning": {"start_s": 0.0, "end_s": middle},
        "comparison": {"start_s": middle, "end_s": end},
        "cells": {"columns": 1, "rows": 2},
        "chain": {"lag_s": frame},
        "mixing": {"split_z_m": low},
        "discussion": {"cell_sizes_m": [times(bed.diameter, bed.cell)]},
        "figures": {"batch_height_m": low, "moments_s": [frame]},
    }  # fmt: skip
    for section, keys in bed.more.items():
        case[section] = case[section] | keys
    return case


def scene(bed: StabilityBed) -> Scene:
    """Physical numbers of a bed, for its limits.

    Raises
    ------
    UserError
        The particles are no heavier than the gas.
    """
    case = case_of(bed)
    case["bed"]["layers"], case["gas"]["model"] = "one", "coupled"
    case["gas"].setdefault("smoothing_diameters_1", SMOOTHING)
    return scene_of(case)


def changes(bed: StabilityBed) -> dict[str, Any]:
    """Differences from the plain bed, by dotted key."""
    plain, case = case_of(StabilityBed()), case_of(bed)
    return {
        f"{section}.{key}": value
        for section, keys in case.items()
        if isinstance(keys, dict)
        for key, value in keys.items()
        if plain[section].get(key) != value
    }
