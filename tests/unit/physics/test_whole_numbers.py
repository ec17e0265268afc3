# SPDX-License-Identifier: GPL-3.0-or-later
"""Multiples, primes and rounding by hand."""

from bedchain.physics.whole_numbers import is_multiple, is_prime


def test_multiples_allow_for_round_off_and_for_no_more():
    assert is_multiple(0.025, 2e-5) and is_multiple(0.3, 0.1)
    assert not is_multiple(0.025, 1.2e-5) and not is_multiple(0.0, 0.1)


def test_primes_below_thirty():
    assert [number for number in range(30) if is_prime(number)] == [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]
