# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a bed and its steps, each refused with key, line and remedy."""

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
    ("seed: 15485863", "seed: 4294967311", "seed", "at most 2147483647"),
    (END, "  dem_step_s: 5e-5\n" + END, "time.dem_step_s", "allow_unstable_step"),
    (END, "  frame_interval_s: 0.02501\n" + END, "time.frame_interval_s", "multiple"),
    (END, "  segment_s: 0.51\n" + END, "time.segment_s", "take 0.5"),
]


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, old, new, key, message):
    assert_refused(changed_case(tmp_path, (old, new)), key, message)


def test_the_explicit_key_allows_an_unstable_step(tmp_path):
    step = "  dem_step_s: 5e-5\n  allow_unstable_step: true\n"
    assert load_case(changed_case(tmp_path, (END, step + END)))["time"]["dem_step_s"] == 5e-5
