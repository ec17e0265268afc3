# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the particles: seed, size of the bed, contacts, DEM step, and the times that it divides."""

from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.physics.contacts import rayleigh_time, static_overlap
from bedchain.physics.packing import LAYER_DISTANCE, START_SPACING_DIAMETERS, settled_height, start_height
from bedchain.physics.whole_numbers import is_multiple, is_prime, nearest_multiple, rounded_down

# up to it collisions have their restitution on average, each within a few per cent (`./run verify`), and beds
# stay at rest to 0.5 (`./run stability`); time.allow_unstable_step overrides it
RAYLEIGH_SHARE_MAX = 0.4
# share of the height that the settled bed may take: it starts 1.4 times as high, as a loose lattice
FILLED_HEIGHT_MAX = 0.7
# of the diameter: the lowest layer of the paper's bed has 0.06; where it is 0.095 a bed sags by 16 %
OVERLAP_AT_REST_MAX = 0.09
CARRYING_KEYS = (
    "contact.poisson_ratio_1", "particles.density_kg_m3", "particles.diameter_m", "particles.number",
    "bed.width_m", "bed.thickness_m",
)  # fmt: skip
BED_KEYS = ("bed.width_m", "bed.height_m", "bed.thickness_m", "bed.layers")


@reads("seed")
def seed_is_prime(seed: int) -> Iterator[Finding]:
    """Refuse a seed that LIGGGHTS does not accept."""
    if not is_prime(seed):
        near = next(number for number in range(seed, 2 * seed) if is_prime(number))
        yield "seed", f"{seed} is not prime, and LIGGGHTS takes only primes above 10000", f"take {near}"


@reads(*BED_KEYS, "particles.diameter_m", "particles.number")
def particles_fit(
    width: float, height: float, thickness: float, layers: str, diameter: float, number: int
) -> Iterator[Finding]:
    """Refuse a bed narrower than a particle, or too low for all particles."""
    many = layers == "many"
    # between a front and a back wall the lattice at the start has several layers
    across = START_SPACING_DIAMETERS * diameter if many else diameter
    thinnest = across if many else LAYER_DISTANCE * diameter
    sizes = (("width_m", width, across), ("height_m", height, diameter), ("thickness_m", thickness, thinnest))
    narrow = [(name, length, least) for name, length, least in sizes if length < least]
    for name, length, least in narrow:
        wrong = f"{length:g} m is narrower than a particle (particles.diameter_m {diameter:g} m)"
        if length >= diameter:
            wrong = f"{length:g} m is narrower than the lattice that particles start from ({least:g} m)"
        yield f"bed.{name}", wrong, "widen the bed or shrink the particles; both are in metres"
    if narrow:
        return
    settled = settled_height(number, diameter, width, thickness if many else None)
    # particles beyond the sites of the lattice at the start would not exist
    fits = width >= START_SPACING_DIAMETERS * diameter
    started = start_height(number, diameter, width, thickness if many else None) if fits else 0
    needed = max(settled / FILLED_HEIGHT_MAX, started)
    if needed > height:
        wrong = f"{number} settle about {settled:.3g} m deep in a bed {height:g} m high"
        most = int(number * height / needed)
        yield "particles.number", wrong, f"take at most {most}, or raise bed.height_m to {needed:.3g}"


@reads(
    "time.dem_step_s",
    "time.allow_unstable_step",
    "contact.young_modulus_Pa",
    "contact.poisson_ratio_1",
    "particles.density_kg_m3",
    "particles.diameter_m",
)
def step_is_stable(
    step: float, allowed: bool, young: float, poisson: float, density: float, diameter: float
) -> Iterator[Finding]:
    """Refuse a DEM step that is too large a share of the Rayleigh time."""
    limit = RAYLEIGH_SHARE_MAX * rayleigh_time(young, poisson, density, diameter / 2)
    if step > limit and not allowed:
        softer = young * (limit / step) ** 2
        wrong = (
            f"{step:g} s is above {limit:.4g} s, {RAYLEIGH_SHARE_MAX:.0%} of the Rayleigh time "
            "pi r sqrt(rho/G) / (0.1631 nu + 0.8766)"
        )
        remedy = (
            f"take at most {rounded_down(limit)}, "
            f"or contact.young_modulus_Pa at most {rounded_down(softer)}, "
            "or set time.allow_unstable_step: true"
        )
        yield "time.dem_step_s", wrong, remedy


@reads("contact.young_modulus_Pa", *CARRYING_KEYS)
def particles_carry_the_bed(
    young: float, poisson: float, density: float, diameter: float, number: int, width: float, depth: float
) -> Iterator[Finding]:
    """Refuse particles so soft that the lowest ones overlap too far under the weight of the bed."""
    overlap = static_overlap(young, poisson, density, diameter, number, width, depth)
    if overlap > OVERLAP_AT_REST_MAX:
        stiffer = young * (overlap / OVERLAP_AT_REST_MAX) ** 1.5
        wrong = (
            f"{young:g} Pa lets the lowest particles overlap by {overlap:.3g} diameters under the settled "
            f"bed, above {OVERLAP_AT_REST_MAX:g}: (3 F / (4 E* sqrt(R*)))^(2/3) / d (Hertz)"
        )
        yield "contact.young_modulus_Pa", wrong, f"take at least {stiffer:.4g}"


@reads("time.dem_step_s", "time.settle_s", "time.frame_interval_s", "time.segment_s", "time.end_s")
def steps_nest(dem: float, settle: float, frame: float, segment: float, end: float) -> Iterator[Finding]:
    """Refuse times that are no whole number of the steps that they consist of."""
    pairs = [
        ("settle_s", settle, "dem_step_s", dem),
        ("frame_interval_s", frame, "dem_step_s", dem),
        ("segment_s", segment, "frame_interval_s", frame),
        ("end_s", end, "frame_interval_s", frame),
    ]
    for name, length, unit_name, unit in pairs:
        if not is_multiple(length, unit):
            wrong = f"{length:g} s is no multiple of time.{unit_name} ({unit:g} s)"
            yield f"time.{name}", wrong, f"take {nearest_multiple(length, unit):.10g}"
