# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact ratios of decimal numbers, multiples, and primes."""

import math
from fractions import Fraction


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


def is_prime(number: int) -> bool:
    """Whether a positive number is prime, by trial division."""
    return number > 1 and all(number % divisor for divisor in range(2, math.isqrt(number) + 1))
