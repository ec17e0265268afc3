# SPDX-License-Identifier: GPL-3.0-or-later
"""MPI ranks that cannot share a bed are refused with the number that can; auto takes what fits."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.rank_checks import most_ranks, most_sharing
from made.case_text import END, assert_refused, changed_case


def ranks(folder, number, *changes):
    return changed_case(folder, (END, END + "\nrun:\n  ranks: " + str(number)), *changes)


@pytest.mark.parametrize(
    ("number", "message"),
    [(4, "take run.ranks: 3"), (27, "take run.ranks: 18"), (0, "at least 1"), ("two", "auto")],
)
def test_ranks_that_cannot_share_the_bed_are_refused(tmp_path, number, message):
    assert_refused(ranks(tmp_path, number), "run.ranks", message)


def test_slabs_below_half_a_neighbour_skin_are_refused(tmp_path):
    # 0.09 m in 450 slabs of 0.2 mm, half a skin is up to 0.45 mm
    assert_refused(ranks(tmp_path, 450), "run.ranks", "take")
    assert_refused(
        ranks(tmp_path, 450, ("split_z_m: 0.081", "split_z_m: 0.081\ngas: {cell_size_m: 2.0e-4}")),
        "run.ranks",
        "take at most 19",
    )


def test_auto_takes_the_most_that_share_the_gas_cells(tmp_path):
    case = load_case(ranks(tmp_path, "auto"))
    assert [most_ranks(case, cores) for cores in (1, 2, 5, 8, 64)] == [1, 2, 3, 6, 18]
    assert most_ranks(load_case(ranks(tmp_path, 6)), 2) == 6


def test_ranks_that_share_are_divisors():
    assert [most_sharing(20, number) for number in (1, 3, 6, 19, 40)] == [1, 2, 5, 10, 20]
