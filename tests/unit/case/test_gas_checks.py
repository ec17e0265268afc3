# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the gas and its steps, each refused with key, line and remedy."""

import pytest

from made.case_text import END, assert_refused, changed_case

MISTAKES = [
    # replaced, by, key named, in the message
    (END, "  dem_step_s: 1.5e-5\n" + END, "time.gas_step_s", "multiple of time.dem_step_s"),
    (END, "  gas_step_s: 3e-4\n" + END, "time.frame_interval_s", "multiple of time.gas_step_s"),
    (END, "  ramp_s: 5.0\n" + END, "time.ramp_s", "not before"),
    (END, "  gas_step_s: 1e-2\n" + END, "time.gas_step_s", "Courant"),
    (
        "split_z_m: 0.081",
        "split_z_m: 0.081\ngas:\n  cell_size_m: 0.004",
        "gas.cell_size_m",
        "does not divide",
    ),
    ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  cell_size_m: 0.01", "run.ranks", "take run.ranks: 1"),
]


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, old, new, key, message):
    assert_refused(changed_case(tmp_path, (old, new)), key, message)
