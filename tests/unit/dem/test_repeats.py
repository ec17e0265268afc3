# SPDX-License-Identifier: GPL-3.0-or-later
"""Seeds and starts of repeats."""

import pytest

from bedchain.dem.repeats import LARGEST_SEED, kick_seed, repeat_ranks, repeats_at_once, segment_that_ends
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import is_prime


def test_seeds_of_repeats_are_different_primes():
    for seed in (10007, 15485863, 32452843, LARGEST_SEED):
        seeds = [kick_seed(seed, number) for number in range(1, 20)]
        assert len(set(seeds)) == len(seeds)
        assert all(is_prime(found) and 10000 < found <= LARGEST_SEED for found in seeds)


def test_a_repeat_finds_its_segment_or_says_where_it_can_start():
    ends = (0.5, 1.0, 1.5)
    segments = [{"end_s": end, "folder": f"dem/a/segment_{i}"} for i, end in enumerate(ends)]
    manifest = {"dem_step_s": 2e-5, "segments": segments}
    assert segment_that_ends(manifest, 1.0000001).name == "segment_1"
    with pytest.raises(UserError, match=r"ends at 1.2 s.*take 1 s.*time.segment_s that divides 1.2 s"):
        segment_that_ends(manifest, 1.2)


def test_several_repeats_run_side_by_side_on_one_rank_each():
    assert [repeat_ranks(2, repeats) for repeats in (1, 2, 3)] == [2, 1, 1]
    assert repeat_ranks(1, 3) == 1
    # on two cores: two of one rank, one of two or more
    assert [repeats_at_once(*of) for of in ((1, 3), (1, 1), (2, 3), (4, 3))] == [2, 1, 1, 1]
