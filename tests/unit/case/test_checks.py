# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a case: all of them are registered, and each reads keys that exist."""

import subprocess
import sys

import pytest

from bedchain.case.checks import CHECKS
from bedchain.case.schema import load_schema, schema_keys
from made import ROOT

NAMES = {
    "a_box_has_gas_and_a_drum_has_none", "a_revolution_has_frames", "cells_hold_particles",
    "cells_of_the_discussion_hold_particles", "drum_is_dumped_in_binary_and_once",
    "drum_is_round_and_flat", "gas_cells_fit", "gas_cells_resolve_the_bed", "gas_is_light",
    "gas_step_is_stable", "gas_step_resolves_the_fall", "gas_steps_nest", "lag_fits",
    "moments_are_frames", "particles_carry_the_bed", "particles_fit", "particles_fit_into_the_drum",
    "ranks_share_gas_evenly", "repeats_start_at_a_segment", "seed_is_prime", "splits_lie_in_bed",
    "step_is_stable", "steps_nest", "windows_lie_in_time",
}  # fmt: skip
LIST_CHECKS = (
    "from bedchain.case.check_registry import CHECKS; print(*[check.__name__ for _, check in CHECKS])"
)


@pytest.mark.parametrize("module", ["load", "checks", "presets"])
def test_every_check_is_registered_by_the_modules_that_need_them(module):
    command = [sys.executable, "-c", f"import bedchain.case.{module}; {LIST_CHECKS}"]
    done = subprocess.run(command, cwd=ROOT / "scripts", capture_output=True, text=True, check=True)
    assert sorted(done.stdout.split()) == sorted(NAMES)


def test_checks_read_keys_of_the_schema():
    known = {*schema_keys(load_schema()), "scene"}
    assert len(CHECKS) == len(NAMES)
    assert {key for keys, _ in CHECKS for key in keys} <= known
