# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact ratios of decimal numbers, multiples, and primes."""

import math
from fractions import Fraction

# steps are cut by products of these alone, so that they are decimal numbers with few digits
PRIMES = (2, 5)
ROUND_OFF = 1e-9


def ratio(length: float, unit: float) -> Fraction:
    """``length / unit`` of the decimal numbers, exact (0.025 / 2e-5 is 1250)."""
    return Fraction(repr(length)) / Fraction(repr(unit))


def span(start: float, end: float) -> Fraction:
    """``end - start`` of the decimal numbers, exact (0.15 - 0.1 is 0.05, in floating point less)."""
    return ratio(end, 1.0) - ratio(start, 1.0)


def is_multiple(length: float, unit: float) -> bool:
    """Whether `length` is a whole number of `unit`, at least one."""
    steps = ratio(length, unit)
    return steps.denominator == 1 and steps >= 1


def nearest_multiple(length: float, unit: float) -> float:
    """Multiple of `unit` nearest to `length`, at least `unit`."""
    return float(max(1, round(length / unit)) * Fraction(repr(unit)))


def rounded_down(value: float) -> str:
    """A positive value rounded down to three digits: a limit that is advised must be allowed."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / digit) * digit:.3g}"


def dividing_step(whole_s: float, wanted_s: float) -> float:
    """The longest step up to about `wanted_s` that divides a time, with few decimal digits [s]."""
    number = math.ceil(whole_s / wanted_s * (1 - ROUND_OFF))
    while _without(PRIMES, number) != 1:
        number += 1
    return float(Fraction(repr(whole_s)) / number)


def _without(primes: tuple[int, ...], number: int) -> int:
    """A number divided by all its factors among some primes."""
    for prime in primes:
        while number % prime == 0:
            number //= prime
    return number


def is_prime(number: int) -> bool:
    """Whether a positive number is prime, by trial division."""
    return number > 1 and all(number % divisor for divisor in range(2, math.isqrt(number) + 1))
