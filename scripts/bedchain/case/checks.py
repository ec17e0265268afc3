# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a case makes sense: physics, steps, windows. Each check is told the keys that it reads."""

from collections.abc import Callable, Iterator
from typing import Any

from bedchain.errors import Problem
from bedchain.physics.contacts import rayleigh_time
from bedchain.physics.fluidization import courant_number
from bedchain.physics.packing import LAYER_DISTANCE, START_SPACING_DIAMETERS, settled_height, start_height
from bedchain.physics.whole_numbers import is_multiple, is_prime, nearest_multiple, ratio, rounded_down

RAYLEIGH_SHARE_MAX = 0.2  # the usual limit for Hertz contacts; time.allow_unstable_step overrides it
COURANT_MAX = 1.0  # a gas parcel crosses at most one cell a step
FILLED_HEIGHT_MAX = (
    0.7  # share of the height that the settled bed may take: it starts 1.4 times as high, as a loose lattice
)

Finding = tuple[str, str, str]
Check = Callable[..., Iterator[Finding]]
CHECKS: list[tuple[tuple[str, ...], Check]] = []


def reads(*keys: str) -> Callable[[Check], Check]:
    """Register a check that gets the values of these keys and yields (key, what is wrong, remedy)."""

    def register(check: Check) -> Check:
        CHECKS.append((keys, check))
        return check

    return register


def physical_problems(case: dict[str, Any], broken: set[str], lines: dict[str, int]) -> list[Problem]:
    """All that the checks find wrong; a check whose keys are missing or already refused is left out.

    Parameters
    ----------
    case : dict
        The case with its defaults.
    broken : set of str
        Dotted keys that the schema refused.
    lines : dict of str to int
        Dotted key -> line in the file.
    """
    values = {key: value for key, value in case.items() if not isinstance(value, dict)}
    for section, group in case.items():
        if isinstance(group, dict):
            values |= {f"{section}.{key}": value for key, value in group.items()}
    refused = {key.split("[")[0] for key in broken}
    problems = []
    for keys, check in CHECKS:
        if all(key in values and key not in refused for key in keys):
            found = check(*(values[key] for key in keys))
            problems += [Problem(key, wrong, remedy, lines.get(key)) for key, wrong, remedy in found]
    return problems


@reads("seed")
def seed_is_prime(seed: int) -> Iterator[Finding]:
    """Refuse a seed that LIGGGHTS would not take."""
    if seed > 2**31 - 1:
        yield (
            "seed",
            f"{seed} does not fit into 31 bits",
            "take a prime of 10007 to 2147483647, such as 15485863",
        )
    elif not is_prime(seed):
        near = next(number for number in range(seed, 2 * seed) if is_prime(number))
        yield "seed", f"{seed} is not prime, and LIGGGHTS takes only primes above 10000", f"take {near}"


BED_KEYS = ("bed.width_m", "bed.height_m", "bed.thickness_m", "bed.layers")


@reads(*BED_KEYS, "particles.diameter_m", "particles.number")
def particles_fit(
    width: float, height: float, thickness: float, layers: str, diameter: float, number: int
) -> Iterator[Finding]:
    """Refuse a bed narrower than a particle, or too low for all of them."""
    many = layers == "many"
    # Between walls the particles start from a lattice in three dimensions
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
    # What does not fit into the lattice that they start from would not be there at all
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
    """Refuse a step of the particles above the usual share of the Rayleigh time."""
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


@reads("gas.superficial_velocity_m_s", "time.gas_step_s", "gas.cell_size_m")
def gas_step_is_stable(velocity: float, step: float, cell: float) -> Iterator[Finding]:
    """Refuse a step of the gas in which it crosses more than a cell."""
    courant = courant_number(velocity, step, cell)
    if courant > COURANT_MAX:
        wrong = f"{step:g} s gives a gas Courant number of about {courant:.3g}, above {COURANT_MAX:g}"
        most = step * COURANT_MAX / courant
        yield "time.gas_step_s", wrong, f"take at most {rounded_down(most)} s, or a larger gas.cell_size_m"


@reads("gas.cell_size_m", "bed.width_m", "bed.height_m", "particles.diameter_m")
def gas_cells_fit(cell: float, width: float, height: float, diameter: float) -> Iterator[Finding]:
    """Refuse gas cells that do not divide the bed, or are smaller than a particle."""
    if cell < diameter:
        wrong = f"{cell:g} m is smaller than a particle: the gas is averaged over many"
        yield (
            "gas.cell_size_m",
            wrong,
            f"take at least particles.diameter_m ({diameter:g} m), usually 3 to 5 of it",
        )
    for name, length in (("width_m", width), ("height_m", height)):
        if not is_multiple(length, cell):
            near = length / max(1, round(length / cell))
            wrong = f"{cell:g} m does not divide bed.{name} ({length:g} m)"
            yield "gas.cell_size_m", wrong, f"take {near:.6g}, or another bed.{name}"


@reads("run.ranks", "gas.cell_size_m", "bed.width_m")
def ranks_share_gas_evenly(ranks: int, cell: float, width: float) -> Iterator[Finding]:
    """Refuse ranks that cannot have slabs of equally many gas cells."""
    cells = ratio(width, cell)
    if cells.denominator == 1 and cells % ranks:
        wrong = f"{ranks} ranks cannot share {cells} gas cells along the width evenly"
        yield "run.ranks", wrong, "take run.ranks: 1, or another gas.cell_size_m"


@reads("time.dem_step_s", "time.settle_s", "time.frame_interval_s", "time.segment_s", "time.end_s")
def steps_nest(dem: float, settle: float, frame: float, segment: float, end: float) -> Iterator[Finding]:
    """Refuse times that are no whole number of the steps they are made of."""
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


@reads(
    "learning.start_s",
    "learning.end_s",
    "comparison.start_s",
    "comparison.end_s",
    "time.end_s",
    "time.frame_interval_s",
)
def windows_lie_in_time(
    learn_start: float, learn_end: float, compare_start: float, compare_end: float, end: float, frame: float
) -> Iterator[Finding]:
    """Refuse windows outside the simulated time, between frames, or overlapping."""
    for name, first, last in (
        ("learning", learn_start, learn_end),
        ("comparison", compare_start, compare_end),
    ):
        if last <= first:
            yield f"{name}.end_s", f"{last:g} s is not after {name}.start_s ({first:g} s)", "take a later end"
        if last > end:
            wrong = f"{last:g} s is outside the simulated time, 0 to {end:g} s"
            yield f"{name}.end_s", wrong, f"take at most {end:g}, or raise time.end_s to {last:g}"
        for edge, time in (("start_s", first), ("end_s", last)):
            if ratio(time, frame).denominator != 1:
                wrong = f"{time:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
                yield f"{name}.{edge}", wrong, f"take {nearest_multiple(time, frame):.10g}"
    if compare_start < learn_end:
        wrong = (
            f"{compare_start:g} s is inside the learning window, {learn_start:g} to {learn_end:g} s: "
            "the chain would be tested on what it learned"
        )
        yield "comparison.start_s", wrong, f"take at least {learn_end:g}, or an earlier learning.end_s"


@reads("discussion.cell_sizes_m", "particles.diameter_m")
def cells_of_the_discussion_hold_particles(sizes: list[float], diameter: float) -> Iterator[Finding]:
    """Refuse cells smaller than a particle."""
    for size in sizes:
        if size < diameter:
            wrong = f"{size:g} m is smaller than a particle ({diameter:g} m)"
            yield "discussion.cell_sizes_m", wrong, f"take at least {diameter:g}"


@reads("comparison.repeats", "comparison.start_s", "time.segment_s", "gas.model")
def repeats_start_at_a_segment(
    repeats: int, start: float, segment: float, gas_model: str
) -> Iterator[Finding]:
    """Refuse repeats without gas, or from within a segment: the state is kept at its end only."""
    if repeats and gas_model == "none":
        yield (
            "comparison.repeats",
            f"{repeats} repeats of a scene without gas",
            "take 0: only beds are repeated",
        )
    if repeats and not is_multiple(start, segment):
        wrong = f"{repeats} repeats cannot start at comparison.start_s ({start:g} s), within a segment"
        yield "comparison.repeats", wrong, f"take a time.segment_s that divides {start:g}, or 0 repeats"


@reads(
    "chain.lag_s",
    "time.frame_interval_s",
    "learning.start_s",
    "learning.end_s",
    "comparison.start_s",
    "comparison.end_s",
)
def lag_fits(
    lag: float, frame: float, learn_start: float, learn_end: float, compare_start: float, compare_end: float
) -> Iterator[Finding]:
    """Refuse a lag between frames, or too long for the windows."""
    if not is_multiple(lag, frame):
        wrong = f"{lag:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
        yield "chain.lag_s", wrong, f"take {nearest_multiple(lag, frame):.10g}"
    shorter = min(learn_end - learn_start, compare_end - compare_start)
    if 0 < shorter < 2 * lag:
        wrong = f"{lag:g} s: the shorter window ({shorter:g} s) holds less than two of it"
        yield "chain.lag_s", wrong, "take a shorter lag or longer windows; the dynamic chain needs two lags"


@reads("cells.columns", "cells.rows", "bed.width_m", "bed.height_m", "particles.diameter_m")
def cells_hold_particles(
    columns: int, rows: int, width: float, height: float, diameter: float
) -> Iterator[Finding]:
    """Refuse cells narrower than a particle."""
    for name, cells, length in (("columns", columns, width), ("rows", rows, height)):
        if ratio(length, diameter) < cells:
            wrong = f"{cells} cells over {length:g} m are narrower than a particle ({diameter:g} m)"
            yield f"cells.{name}", wrong, f"take at most {int(ratio(length, diameter))}"


@reads("mixing.split_x_m", "mixing.split_z_m", "figures.batch_height_m", "bed.width_m", "bed.height_m")
def splits_lie_in_bed(
    split_x: float, split_z: float, batch: float, width: float, height: float
) -> Iterator[Finding]:
    """Refuse dividing lines outside the bed."""
    lines = [
        ("mixing.split_x_m", split_x, "width_m", width),
        ("mixing.split_z_m", split_z, "height_m", height),
    ]
    for key, place, name, length in [*lines, ("figures.batch_height_m", batch, "height_m", height)]:
        if place >= length:
            yield (
                key,
                f"{place:g} m is outside the bed (bed.{name} {length:g} m)",
                f"take less than {length:g}",
            )


@reads("figures.moments_s", "time.frame_interval_s", "comparison.start_s", "comparison.end_s")
def moments_are_frames(moments: list[float], frame: float, start: float, end: float) -> Iterator[Finding]:
    """Refuse moments between frames, or after the comparison."""
    for moment in moments:
        if not is_multiple(moment, frame):
            wrong = f"{moment:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
            yield "figures.moments_s", wrong, f"take {nearest_multiple(moment, frame):.10g}"
        if 0 < end - start < moment:
            wrong = f"{moment:g} s is after the end of the comparison, which lasts {end - start:g} s"
            yield "figures.moments_s", wrong, "leave it out, or take a later comparison.end_s"
