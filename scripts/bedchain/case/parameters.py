# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of both solvers from a case, as a LIGGGHTS include and an OpenFOAM dictionary."""

import math
from dataclasses import dataclass

from bedchain.case.parcels import parcel_case, parcel_diameters, particles_per_parcel
from bedchain.case.schema import Case, Schema, case_value, schema_keys
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.physics.fluidization import ergun_velocity
from bedchain.physics.packing import (
    LAYER_DISTANCE,
    PACKED_AREA_SHARE,
    PACKED_VOLUME_SHARE,
    START_SPACING_DIAMETERS,
    converted_thickness,
    slab_voidage,
)
from bedchain.physics.whole_numbers import ratio

# Neighbour skin [diameters]: a list is valid until a particle has moved by half of it. It changes the speed,
# not the physics: lists are made anew by distance, forces by step, so that the cheapest skin grows with the
# root of the step, here of step over diameter [s/m]
SKIN_LEAST, SKIN_MOST, SKIN_GROWTH = 0.5, 0.9, 2.5
START_SPEED_M_S = 0.05  # random, breaks the lattice; without effect after the fall
DUMP_SUFFIX = {"binary": "bin", "text": "txt"}


@dataclass(frozen=True)
class Parameter:
    """A number or word that a solver needs.

    Attributes
    ----------
    name : str
        Name in decks and dictionaries.
    value : int, float or str
        Value in the unit.
    unit : str
        Unit.
    source : str
        Origin: a key of the case, or the formula.
    """

    name: str
    value: int | float | str
    unit: str
    source: str


def solver_parameters(case: Case, schema: Schema) -> list[Parameter]:
    """All parameters that the solvers need of a case.

    Parameters
    ----------
    case : dict
        A checked case, of `case.load.load_case`.
    schema : dict
        The schema; its ``x-variable`` marks the keys that the solvers need.

    Returns
    -------
    list of Parameter
        Keys in the order of the schema, then the derived ones; those of parcels where the case has them.
    """
    simulated = parcel_case(case)
    given = [
        Parameter(
            part["x-variable"], case_value(simulated, key), part["x-unit"], _source(key, case, simulated)
        )
        for key, part in schema_keys(schema).items()
        if "x-variable" in part
    ]
    grain = Parameter(
        "particle_diameter", case["particles"]["diameter_m"], "m", "particles.diameter_m, which drag goes by"
    )
    counted = Parameter(
        "particles_per_parcel",
        particles_per_parcel(case),
        "1",
        "l^2 in a bed of one layer, l^3 in a thick one",
    )
    return [*given, *derived_parameters(simulated), grain, counted]


def _source(key: str, case: Case, simulated: Case) -> str:
    """The key of a value, with the parcels that changed it."""
    same = case_value(case, key) == case_value(simulated, key)
    return key if same else f"{key}, for parcels of {parcel_diameters(case):g} diameters"


def derived_parameters(case: Case) -> list[Parameter]:
    """Numbers that follow from the keys, such as steps from times (whole in a checked case)."""
    time, bed, particles = case["time"], case["bed"], case["particles"]
    cell = case["gas"]["cell_size_m"]
    diameter, thickness = particles["diameter_m"], bed["thickness_m"]
    many = bed["layers"] == "many"
    cells_y = max(1, round(thickness / cell)) if many else 1
    skin = skin_diameters(time["dem_step_s"], diameter)
    return [
        Parameter("gravity", GRAVITY_M_S2, "m/s2", "constant, along -z"),
        Parameter("rolling_law", rolling_law(case), "name", "from contact.rolling_friction_1"),
        Parameter(
            "hooke_velocity", math.sqrt(GRAVITY_M_S2 * bed["width_m"]), "m/s", "sqrt(gravity bed.width_m)"
        ),
        Parameter("radius", diameter / 2, "m", "particles.diameter_m / 2"),
        Parameter("slab_low", -thickness / 2, "m", "-bed.thickness_m / 2"),
        Parameter("slab_high", thickness / 2, "m", "bed.thickness_m / 2"),
        Parameter("depth_walls", int(many), "1", "bed.layers: 1 where particles move in y between walls"),
        Parameter("skin", skin * diameter, "m", f"{skin:g} diameters"),
        Parameter(
            "settle_spacing", START_SPACING_DIAMETERS * diameter, "m", f"{START_SPACING_DIAMETERS} diameters"
        ),
        Parameter("settle_speed", START_SPEED_M_S, "m/s", "constant, random start"),
        Parameter("gas_cells_x", int(ratio(bed["width_m"], cell)), "1", "bed.width_m / gas.cell_size_m"),
        Parameter("gas_cells_y", cells_y, "1", "bed.thickness_m / gas.cell_size_m, rounded; 1 for one layer"),
        Parameter("faces_type", "wall" if cells_y > 1 else "empty", "name", "from gas_cells_y"),
        Parameter("gas_cells_z", int(ratio(bed["height_m"], cell)), "1", "bed.height_m / gas.cell_size_m"),
        _steps("coupling_steps", time, "gas_step_s"),
        _steps("settle_steps", time, "settle_s"),
        _steps("frame_steps", time, "frame_interval_s"),
        Parameter("dump_suffix", DUMP_SUFFIX[case["run"]["dump_format"]], "name", "run.dump_format"),
        *drum_parameters(case),
    ]


def skin_diameters(step_s: float, diameter_m: float) -> float:
    """Neighbour skin for a step [s] of particles of a diameter [m], in diameters."""
    return min(SKIN_MOST, max(SKIN_LEAST, SKIN_GROWTH * math.sqrt(step_s / diameter_m)))


def rolling_law(case: Case) -> str:
    """LIGGGHTS's word for the rolling resistance: an elastic-plastic spring (Ai et al. 2011), or none."""
    return "epsd2" if case["contact"]["rolling_friction_1"] > 0 else "off"


def drum_parameters(case: Case) -> list[Parameter]:
    """Angular velocity of a drum; empty for a bed in a box."""
    if "drum" not in case:
        return []
    speed = 2 * math.pi / case["drum"]["revolution_s"]
    return [Parameter("drum_speed", speed, "rad/s", "2 pi / drum.revolution_s")]


def weight_per_area(case: Case) -> float:
    """Weight of the particles over the bed's cross section [Pa]: the pressure drop of the fluidized bed."""
    bed, particles = case["bed"], case["particles"]
    volume = particles["number"] * math.pi / 6 * particles["diameter_m"] ** 3
    return float(particles["density_kg_m3"] * volume * GRAVITY_M_S2 / (bed["width_m"] * bed["thickness_m"]))


def _steps(name: str, time: dict[str, float], key: str) -> Parameter:
    return Parameter(name, int(ratio(time[key], time["dem_step_s"])), "1", f"time.{key} / time.dem_step_s")


def liggghts_text(parameters: list[Parameter]) -> str:
    """The LIGGGHTS include: ``variable young equal 1900000.0  # [Pa] contact.young_modulus_Pa``."""
    lines = ["# made by scripts/write_parameters.py; edit the case file instead"]
    for parameter in parameters:
        style = "string" if isinstance(parameter.value, str) else "equal"
        comment = f"# [{parameter.unit}] {parameter.source}"
        lines.append(f"variable {parameter.name} {style} {parameter.value}  {comment}")
    return "\n".join(lines) + "\n"


def openfoam_text(parameters: list[Parameter]) -> str:
    """The OpenFOAM dictionary to ``#include``: ``young 1900000.0; // [Pa] contact.young_modulus_Pa``."""
    lines = ["// made by scripts/write_parameters.py; edit the case file instead"]
    lines += [f"{item.name} {item.value}; // [{item.unit}] {item.source}" for item in parameters]
    return "\n".join(lines) + "\n"


def fluidization_line(case: Case) -> str:
    """Minimum fluidization velocity of a case and of other slab thicknesses, as a line of the log."""
    bed, particles, gas = case["bed"], case["particles"], case["gas"]
    diameter = particles["diameter_m"]
    spheres = (diameter, particles["density_kg_m3"], gas["density_kg_m3"], gas["viscosity_Pa_s"])
    if bed["layers"] == "many":
        speed = ergun_velocity(1 - PACKED_VOLUME_SHARE, *spheres)
        return f"u_mf about {speed:.2f} m/s (Ergun, {PACKED_VOLUME_SHARE:g} of the volume packed)"
    thicknesses = {
        "bed.thickness_m": bed["thickness_m"] / diameter,
        "conversion of Hoomans et al. 1996": converted_thickness(PACKED_AREA_SHARE),
        "layers of closest packing": LAYER_DISTANCE,
    }
    parts = []
    for name, thickness in thicknesses.items():
        speed = ergun_velocity(slab_voidage(PACKED_AREA_SHARE, thickness), *spheres)
        parts.append(f"{speed:.2f} m/s at T = {thickness:.3g} d ({name})")
    return f"u_mf about (Ergun, {PACKED_AREA_SHARE:g} of the plane covered) " + ", ".join(parts)
