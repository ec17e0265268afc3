# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that decide whether a case can run: exact ratios, stable steps, the settled height."""

import math
from fractions import Fraction

GRAVITY_M_S2 = 9.81  # standard value, rounded; downwards along z
DENSE_VOIDAGE = 0.4  # of a packed bed; makes the estimate of the gas velocity between particles a high one
PACKED_AREA_SHARE = 0.82  # area covered by one layer of random close-packed discs
PACKED_VOLUME_SHARE = 0.6  # volume filled by spheres after a fall, between random loose and random close
START_SPACING_DIAMETERS = 1.15  # of the loose lattice that the particles fall from: no contact at the start

# Distance of the layers of closest-packed spheres, in diameters: a slab as thick makes of closest discs,
# 0.907 of the plane, closest spheres, 0.740 of space
LAYER_DISTANCE = math.sqrt(2 / 3)


def ratio(length: float, unit: float) -> Fraction:
    """``length / unit``, exact for numbers as they are written in a file (0.025 / 2e-5 is 1250)."""
    return Fraction(repr(length)) / Fraction(repr(unit))


def is_multiple(length: float, unit: float) -> bool:
    """Whether `length` is a whole number of `unit`, at least one."""
    steps = ratio(length, unit)
    return steps.denominator == 1 and steps >= 1


def nearest_multiple(length: float, unit: float) -> float:
    """The multiple of `unit` nearest to `length`, at least one `unit`."""
    return float(max(1, round(length / unit)) * Fraction(repr(unit)))


def rounded_down(value: float) -> str:
    """A positive value with three digits, never above it: what is advised must be allowed."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / digit) * digit:.3g}"


def rayleigh_time(young: float, poisson: float, density: float, radius: float) -> float:
    """Time of a surface wave over a sphere [s], the scale of the stable step.

    ``pi r sqrt(rho / G) / (0.1631 nu + 0.8766)``, ``G = E / (2 (1 + nu))`` (Thornton, Randall 1988).

    Parameters
    ----------
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio [1].
    density : float
        Density of the sphere [kg/m3].
    radius : float
        Radius [m].
    """
    shear = young / (2 * (1 + poisson))
    return math.pi * radius * math.sqrt(density / shear) / (0.1631 * poisson + 0.8766)


def courant_number(velocity: float, step: float, cell: float) -> float:
    """Courant number of the gas in a packed bed [1]: superficial `velocity` [m/s], `step` [s], `cell` [m]."""
    return velocity / DENSE_VOIDAGE * step / cell


def settled_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the settled bed [m], an estimate by random packing.

    Parameters
    ----------
    number : int
        Particles [1].
    diameter, width : float
        Of a particle and of the bed [m].
    depth : float, optional
        Between the walls in front and behind [m]; without it the bed is one layer of discs.
    """
    if depth is None:
        return number * math.pi * diameter**2 / 4 / (PACKED_AREA_SHARE * width)
    return number * math.pi * diameter**3 / 6 / (PACKED_VOLUME_SHARE * width * depth)


def start_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the loose lattice that the particles fall from [m], as ``in.settle`` makes it.

    Parameters
    ----------
    number, diameter, width, depth
        As in `settled_height`; at least one lattice spacing fits into width and depth.
    """
    spacing = START_SPACING_DIAMETERS * diameter
    columns = math.floor(width / spacing)
    layers = 1 if depth is None else math.floor(depth / spacing)
    return math.ceil(number / (columns * layers)) * width / columns


def contact_modulus(young: float, poisson: float) -> float:
    """Modulus of a contact of equal materials [Pa], ``E / (2 (1 - nu^2))`` (Johnson 1985, ch. 4)."""
    return young / (2 * (1 - poisson**2))


def static_overlap(
    young: float, poisson: float, density: float, diameter: float, number: int, width: float, depth: float
) -> float:
    """Overlap of two particles under the weight of a settled bed, over the diameter [1].

    ``(3 F / (4 E* sqrt(R*)))^(2/3) / d``, Hertz (Johnson 1985, Contact Mechanics, ch. 4); ``R* = d / 4``,
    and F what a particle of the lowest layer carries, ``W d / width``, of a bed many particles deep
    ``W d^2 / (width depth)``.

    Parameters
    ----------
    young, poisson : float
        Young's modulus [Pa], Poisson's ratio [1].
    density, diameter : float
        Of the particles [kg/m3], [m].
    number : int
        Particles [1].
    width, depth : float
        Of the bed, and between the walls in front and behind [m]; a depth below a diameter is one layer.
    """
    weight = number * density * math.pi / 6 * diameter**3 * GRAVITY_M_S2
    load = weight * diameter / width * min(1.0, diameter / depth)
    modulus = contact_modulus(young, poisson)
    return (3 * load / (4 * modulus * math.sqrt(diameter / 4))) ** (2 / 3) / diameter


def is_prime(number: int) -> bool:
    """Whether a positive number is prime, by trial division."""
    return number > 1 and all(number % divisor for divisor in range(2, math.isqrt(number) + 1))
