# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a case's bed: one key changed at a time, and pairs of keys that belong together."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from bedchain.case.bed_checks import CARRYING_KEYS, particles_carry_the_bed
from bedchain.case.bed_settings import dem_step, gas_cell, gas_step, parcels, problems_with, stiffness
from bedchain.case.schema import Case, case_value, load_schema
from bedchain.case.variants import Variant
from bedchain.errors import UserError, report_user_errors
from bedchain.physics.whole_numbers import is_prime

# Young's modulus over the case's; the step goes with its root, so that its share of the Rayleigh time stays.
# Particles too soft to carry the bed are left out.
STIFFNESSES = (0.1, 0.4, 4.0, 10.0)
STEPS = (0.5, 2.5)
GAS_STEPS = (0.2, 0.5, 2.0)
GAS_CELLS = (0.5, 2.0, 4.0)
# in diameters; a length below 1.4 gas cells changes nothing, since the kernel of the cells is as wide
SMOOTHINGS = (10.0,)
# in diameters; the first is the conversion of Hoomans et al. 1996
THICKNESSES = (0.859, 1.2)
FRICTIONS = (0.0, 0.3)
RESTITUTIONS = (0.8, 0.97)
# an arm of a twentieth of the radius, from which on the audit keeps rolling resistance
ROLLING_FRICTIONS = (0.05,)
# diameters of a parcel; those that do not go with the case are left out
PARCELS = (2.0, 3.0, 4.0)
# parcels [diameters], gas step and gas cell over the case's, together
COMBINATIONS = ((2.0, 2.0, 1.0), (2.0, 2.0, 2.0), (3.0, 2.0, 1.0), (3.0, 2.0, 2.0))
PRESSURE_TOLERANCES = (1e-5, 1e-9)
SEED_SPACING = 1000
SEEDS = 2
OPTIONS = ("dem",)
PARCEL_AXIS, PARCEL_KEY = "parcels", "particles.parcel_diameters"
REALISATION = "realisation"  # axis of the variants that differ only in their random start


@dataclass(frozen=True)
class BedVariant:
    """A variant and its axis of the study.

    Attributes
    ----------
    axis : str
    variant : Variant
    """

    axis: str
    variant: Variant

    @property
    def changed(self) -> str:
        """Differences from the case, in one line."""
        return "; ".join(f"{key} {_shown(value)}" for key, value in self.variant.changes.items())


def bed_variants(case: Case) -> dict[str, BedVariant]:
    """All variants of a case by name, the case itself among them as ``base``.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict
        Most expensive first, so that the last ones end together; without values that the case already has;
        empty for imported frames, which cannot be simulated.
    """
    if "frames" in case:
        return {}
    gas = case["gas"]["model"] != "none"
    variants = {"base": BedVariant(REALISATION, Variant("base"))}
    for axis, name, changes in [*_particles(case), *(_gas(case) if gas else ())]:
        if any(case_value(case, key) != value for key, value in changes.items()):
            variants[name] = BedVariant(axis, Variant(name, changes))
    return dict(sorted(variants.items(), key=lambda item: _step(item[1], case)))


def wanted_variants(option: object, case: Case, archived: bool) -> list[str]:
    """Names of the variants to simulate, from ``--config tradeoff=...``.

    Parameters
    ----------
    option : object
        ``{"dem": names}`` with ``"all"``, ``"none"`` or a list of names. Default: all where the case is
        simulated, none where it comes from its archive.
    case : Case
    archived : bool
        Whether the case comes from its archive.

    Returns
    -------
    list of str
        Of `bed_variants`, in its order.

    Raises
    ------
    UserError
        Another word or an unknown name; lists the known ones.
    """
    remedy = "take --config tradeoff='{dem: all}', none, or a list of names"
    if option is not None and not isinstance(option, Mapping):
        raise UserError(f"tradeoff={option}: {remedy}")
    given = dict(option or {})
    if unknown := sorted(set(given) - set(OPTIONS)):
        raise UserError(f"tradeoff has no {', '.join(unknown)}: {remedy}")
    dem = given.get("dem", "none" if archived else "all")
    known = bed_variants(case)
    if dem in ("all", "none"):
        return list(known) if dem == "all" else []
    names = [dem] if isinstance(dem, str) else dem
    if not isinstance(names, list):
        raise UserError(f"tradeoff.dem {dem}: {remedy}")
    if unknown := [str(name) for name in names if name not in known]:
        raise UserError(f"tradeoff.dem: there is no variant {', '.join(unknown)}; take of {', '.join(known)}")
    return [name for name in known if name in names]


def parcel_beds(case: Case) -> dict[str, str]:
    """Variants that simulate parcels and change nothing else: what they are, by name."""
    beds = bed_variants(case).items()
    sizes = {name: bed.variant.changes.get(PARCEL_KEY) for name, bed in beds if bed.axis == PARCEL_AXIS}
    return {name: f"parcels of {size:g} diameters" for name, size in sizes.items()}


def variants_or_exit(option: object, case: Case, archived: bool) -> list[str]:
    """`wanted_variants`; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        return wanted_variants(option, case, archived)


def _particles(case: Case) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for factor in STIFFNESSES:
        softer = stiffness(case, factor)
        if not any(particles_carry_the_bed(softer["contact.young_modulus_Pa"], *_weight_of(case))):
            yield "stiffness and step", f"stiffness_{factor:g}", softer
    for factor in STEPS:
        # Young's modulus stays: the share of the Rayleigh time is another
        yield "particle step", f"step_{factor:g}", dem_step(case, factor) | {"time.allow_unstable_step": True}
    for value in FRICTIONS:
        yield "ablation", f"friction_{value:g}", {"contact.friction_1": value}
    for value in RESTITUTIONS:
        yield "restitution", f"restitution_{value:g}", {"contact.restitution_1": value}
    for value in ROLLING_FRICTIONS:
        yield "ablation", f"rolling_{value:g}", {"contact.rolling_friction_1": value}
    for law in load_schema()["properties"]["contact"]["properties"]["law"]["enum"]:
        yield "contact law", law, {"contact.law": law}
    seed = case["seed"]
    for number in range(1, SEEDS + 1):
        seed = next(prime for prime in range(seed + SEED_SPACING, 2 * seed) if is_prime(prime))
        yield REALISATION, f"seed_{number}", {"seed": seed}


def _gas(case: Case) -> Iterator[tuple[str, str, dict[str, Any]]]:
    time = case["time"]
    for size in PARCELS:
        if not problems_with(case, parcels(size)):
            yield PARCEL_AXIS, f"parcels_{size:g}", parcels(size)
    for factor in GAS_STEPS:
        yield "gas step", f"gas_step_{factor:g}", gas_step(case, factor)
    for factor in GAS_CELLS:
        yield "gas cell", f"gas_cell_{factor:g}", gas_cell(case, factor)
    for value in SMOOTHINGS:
        yield "smoothing", f"smoothing_{value:g}", {"gas.smoothing_diameters_1": value}
    for value in PRESSURE_TOLERANCES:
        yield "gas solver", f"tolerance_{value:g}", {"gas.pressure_tolerance_1": value}
    for law in load_schema()["properties"]["gas"]["properties"]["drag_law"]["enum"]:
        yield "drag law", f"drag_{law}", {"gas.drag_law": law}
    for value in THICKNESSES if case["bed"]["layers"] == "one" else ():
        thickness = value * case["particles"]["diameter_m"]
        yield "slab thickness", f"thickness_{value:g}", {"bed.thickness_m": thickness}
    for size, longer, wider in COMBINATIONS:
        if not problems_with(case, parcels(size)):
            changes = parcels(size) | gas_step(case, longer) | (gas_cell(case, wider) if wider != 1 else {})
            yield "combination", f"parcels_{size:g}_gas_step_{longer:g}_gas_cell_{wider:g}", changes
    yield "ablation", "ramp_none", {"time.ramp_s": time["gas_step_s"]}
    fine = gas_cell(case, 0.5)
    same_kernel = math.sqrt(2) * case["gas"]["cell_size_m"] / case["particles"]["diameter_m"]
    yield "pair", "gas_cell_0.5_same_kernel", fine | {"gas.smoothing_diameters_1": same_kernel}
    yield "pair", "gas_cell_0.5_gas_step_0.5", fine | gas_step(case, 0.5)


def _weight_of(case: Case) -> list[float]:
    """Values of a case that `particles_carry_the_bed` takes after Young's modulus."""
    return [case_value(case, key) for key in CARRYING_KEYS]


def _step(bed: BedVariant, case: Case) -> float:
    changes = bed.variant.changes
    step = float(changes.get("time.dem_step_s", case["time"]["dem_step_s"]))
    return step * float(changes.get("particles.parcel_diameters", 1)) ** 3  # as many fewer steps of particles


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
