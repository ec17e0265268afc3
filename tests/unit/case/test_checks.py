# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a case's numbers against each other, each refused with key, line and remedy."""

import pytest

from bedchain.case.load import load_case
from made.case_text import END, assert_refused, changed_case

MISTAKES = [
    # replaced, by, key named, in the message
    ("number: 7200", "number: 90000", "particles.number", "at most"),
    ("width_m: 0.09", "width_m: 9.0e-4", "bed.width_m", "narrower than a particle"),
    ("width_m: 0.09", "width_m: 0.09\n  thickness_m: 7.0e-4", "bed.thickness_m", "narrower than a particle"),
    (
        "width_m: 0.09",
        "width_m: 0.09\n  layers: many\n  thickness_m: 1.1e-3",
        "bed.thickness_m",
        "narrower than the lattice",
    ),
    (
        "width_m: 0.09\n  height_m: 0.45\nparticles:\n  number: 7200",
        "width_m: 0.09\n  height_m: 0.45\n  layers: many\n  thickness_m: 0.01\nparticles:\n  number: 400000",
        "particles.number",
        "take at most",
    ),
    ("seed: 15485863", "seed: 15485864", "seed", "15485867"),
    ("seed: 15485863", "seed: 9973", "seed", "above 10000"),
    ("seed: 15485863", "seed: 4294967311", "seed", "31 bits"),
    (END, "  dem_step_s: 5e-5\n" + END, "time.dem_step_s", "allow_unstable_step"),
    (END, "  gas_step_s: 1e-2\n" + END, "time.gas_step_s", "Courant"),
    (END, "  frame_interval_s: 0.02501\n" + END, "time.frame_interval_s", "multiple"),
    (END, "  segment_s: 0.51\n" + END, "time.segment_s", "take 0.5"),
    (END, "  end_s: 4.0", "comparison.end_s", "raise time.end_s to 5"),
    ("  start_s: 1.0", "  start_s: 3.5", "learning.end_s", "not after"),
    ("  start_s: 1.0", "  start_s: 1.01", "learning.start_s", "multiple of time.frame_interval_s"),
    ("comparison:\n  start_s: 3.0", "comparison:\n  start_s: 2.0", "comparison.start_s", "at least 3"),
    ("columns: 10", "columns: 91", "cells.columns", "at most 90"),
    ("split_z_m: 0.081", "split_z_m: 0.5", "mixing.split_z_m", "outside the bed"),
    ("split_z_m: 0.081", "split_z_m: 0.081\nchain:\n  lag_s: 0.03", "chain.lag_s", "take 0.025"),
    (
        "split_z_m: 0.081",
        "split_z_m: 0.081\ngas:\n  cell_size_m: 0.004",
        "gas.cell_size_m",
        "does not divide",
    ),
    ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  cell_size_m: 0.01", "run.ranks", "take run.ranks: 1"),
    ("batch_height_m: 0.027", "moments_s: [0.05, 2.05]", "figures.moments_s", "after the end"),
]


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, old, new, key, message):
    assert_refused(changed_case(tmp_path, (old, new)), key, message)


def test_the_explicit_key_allows_an_unstable_step(tmp_path):
    step = "  dem_step_s: 5e-5\n  allow_unstable_step: true\n"
    assert load_case(changed_case(tmp_path, (END, step + END)))["time"]["dem_step_s"] == 5e-5
