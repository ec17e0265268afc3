# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the scene: a box with gas or a drum without; and the keys of a case that its scene uses."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from bedchain.case.check_registry import Finding, reads
from bedchain.case.frame_checks import FRAMES, without_simulation
from bedchain.case.two_fluid import is_two_fluid, without_particles
from bedchain.physics.packing import START_SPACING_DIAMETERS
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple

READ_WITHOUT_GAS = ("model", "density_kg_m3", "viscosity_Pa_s")  # by the audit
UNUSED_WITHOUT_GAS = {"time": ("gas_step_s", "ramp_s"), "contact": ("largest_overlap_1",)}  # bedFoam's


def used_keys(case: dict[str, Any]) -> dict[str, Any]:
    """The case less the keys that its scene does not use: of gas, of particles, or of frames the solvers'.

    Parameters
    ----------
    case : dict
        The case with its defaults; sections that the schema refused may have any type.
    """
    if FRAMES in case:
        return without_simulation(case)
    if is_two_fluid(case):
        return without_particles(case)
    gas = case.get("gas")
    if not isinstance(gas, dict) or gas.get("model") != "none":
        return case
    used = case | {"gas": {key: value for key, value in gas.items() if key in READ_WITHOUT_GAS}}
    for section, unused in UNUSED_WITHOUT_GAS.items():
        if isinstance(keys := case.get(section), dict):
            used[section] = {key: value for key, value in keys.items() if key not in unused}
    return used


def checked_keys(case: dict[str, Any]) -> dict[str, Any]:
    """`used_keys`, and ``scene``: shape and gas model, such as ``box, coupled`` or ``drum, none``.

    A case of frames is ``frames, none``, and the time of its last frame is ``frames.end_s``.
    """
    if FRAMES in case:
        used = used_keys(case)
        frames = used[FRAMES] | {"end_s": used["time"].get("end_s")}
        return used | {
            "scene": "frames, none",
            FRAMES: frames,
            "time": {"frame_interval_s": used["time"].get("frame_interval_s")},
        }
    gas = case.get("gas")
    model = gas.get("model") if isinstance(gas, dict) else None
    return used_keys(case) | {"scene": f"{'drum' if 'drum' in case else 'box'}, {model}"}


def drum_sites(diameter: float, particle: float) -> int:
    """Sites of the lattice inside a drum that its particles fall from in ``drum/in.fill`` [1].

    Parameters
    ----------
    diameter, particle : float
        Of the drum and of a particle [m].
    """
    spacing = START_SPACING_DIAMETERS * particle
    along = (np.arange(int(diameter / spacing) + 1) + 0.5) * spacing - diameter / 2
    reach = (diameter - particle) / 2
    half_chords = np.sqrt(reach**2 - along[np.abs(along) <= reach] ** 2)
    ends = np.searchsorted(along, half_chords, "right") - np.searchsorted(along, -half_chords, "left")
    return int(ends.sum())


def surely_fit(number: int, diameter: float, particle: float) -> bool:
    """Whether particles fit into the square within a drum, so that its sites need not be counted."""
    side = (diameter - particle) / math.sqrt(2) / (START_SPACING_DIAMETERS * particle) - 1
    return side > 0 and number <= side**2


@reads("scene")
def a_box_has_gas_and_a_drum_has_none(scene: str) -> Iterator[Finding]:
    """Refuse a box without gas, where nothing would move the particles, and gas in a drum."""
    if scene == "box, none":
        remedy = "add drum: {revolution_s: ...}, or take coupled"
        yield "gas.model", "none leaves the particles at rest: nothing moves them but a drum", remedy
    if scene == "drum, coupled":
        yield "gas.model", "coupled does not go with a drum: the gas cells end at flat walls", "take none"


@reads("drum.revolution_s", "bed.width_m", "bed.height_m", "bed.layers")
def drum_is_round_and_flat(revolution: float, width: float, height: float, layers: str) -> Iterator[Finding]:
    """Refuse a drum whose box is not a square, or with more than one layer of particles."""
    if width != height:
        yield "bed.height_m", f"{height:g} m is not the drum's diameter", f"take bed.width_m ({width:g} m)"
    if layers != "one":
        yield "bed.layers", "many is not possible in a drum", "take one"


@reads("drum.revolution_s", "time.frame_interval_s")
def a_revolution_has_frames(revolution: float, frame: float) -> Iterator[Finding]:
    """Refuse a revolution that is no whole number of frames: no matrix could span it."""
    if not is_multiple(revolution, frame):
        wrong = f"{revolution:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
        yield "drum.revolution_s", wrong, f"take {nearest_multiple(revolution, frame):.10g}"


@reads("drum.revolution_s", "bed.width_m", "particles.diameter_m", "particles.number")
def particles_fit_into_the_drum(
    revolution: float, width: float, diameter: float, number: int
) -> Iterator[Finding]:
    """Refuse more particles than the lattice at the start has sites."""
    if diameter > width or surely_fit(number, width, diameter):
        return
    if number > (sites := drum_sites(width, diameter)):
        wrong = f"{number} start on a lattice that has {sites} sites in a drum of {width:g} m"
        yield (
            "particles.number",
            wrong,
            f"take at most {sites}, or a larger drum (bed.width_m and bed.height_m)",
        )


@reads("drum.revolution_s", "run.dump_format", "comparison.repeats")
def drum_is_dumped_in_binary_and_once(revolution: float, form: str, repeats: int) -> Iterator[Finding]:
    """Refuse frames as text, whose columns have other names, and repeats, which need the gas."""
    if form != "binary":
        yield "run.dump_format", f"{form} is not possible for a drum", "take binary"
    if repeats:
        yield "comparison.repeats", f"{repeats} repeats are not possible for a drum", "take 0"
