# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a case: all of them are registered, and each reads keys that exist."""

import copy
import subprocess
import sys

import pytest

from bedchain.case.checks import CHECKS, physical_problems
from bedchain.case.schema import load_schema, schema_keys
from made import ROOT

NAMES = {
    "axes_differ", "frames_are_in_metres", "frames_have_no_repeats", "windows_lie_in_the_frames",
    "a_box_has_gas_and_a_drum_has_none", "a_revolution_has_frames", "cells_can_be_counted",
    "chains_have_one_builder", "colour_maps_exist", "colours_exist", "drag_follows_collisions",
    "earlier_velocities_are_in_the_window",
    "jumps_of_the_recurrence_have_targets", "lags_of_the_discussion_fit",
    "moments_rise",
    "cells_hold_particles", "cells_of_the_recurrence_hold_particles",
    "cells_of_the_discussion_hold_particles", "drum_is_dumped_in_binary_and_once",
    "drum_is_round_and_flat", "gas_cells_fit", "gas_cells_resolve_the_bed", "gas_is_light",
    "gas_step_is_stable", "gas_step_resolves_the_fall", "gas_steps_nest", "lag_fits",
    "lengths_are_in_metres", "steps_can_be_counted",
    "marks_have_one_rule", "models_go_with_the_cells", "round_cells_fit_the_bed",
    "moments_are_frames", "particles_carry_the_bed", "particles_fit", "particles_fit_into_the_drum",
    "ranks_share_gas_evenly", "repeats_start_at_a_segment", "seed_is_prime", "splits_lie_in_bed",
    "step_is_stable", "steps_nest", "windows_lie_in_time",
    "cells_hold_parcels", "gas_cells_hold_parcels", "parcels_are_under_gas", "parcels_can_lose_the_energy",
    "parcels_fit", "two_fluids_are_flat_and_have_their_drag_law",
    "slabs_are_wider_than_a_step_of_the_list",
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
    known = {*schema_keys(load_schema()), "scene", "frames.end_s"}
    assert len(CHECKS) == len(NAMES)
    assert {key for keys, _ in CHECKS for key in keys} <= known


def test_every_check_speaks_of_its_own_keys_and_none_of_broken_ones(paper):
    assert physical_problems(paper, set(), {}) == []
    wrong = copy.deepcopy(paper)
    wrong["seed"], wrong["cells"]["columns"], wrong["gas"]["cell_size_m"] = 4, 1000, 0.004
    problems = physical_problems(wrong, set(), {"seed": 2})
    assert {"seed", "cells.columns", "gas.cell_size_m"} <= {problem.key for problem in problems}
    assert [problem.line for problem in problems if problem.key == "seed"] == [2]
    # what the schema has refused already is not checked again
    left = physical_problems(wrong, {"seed", "cells.columns"}, {})
    assert "gas.cell_size_m" in {problem.key for problem in left}
    assert not {"seed", "cells.columns"} & {problem.key for problem in left}
    # nor what is not there
    del wrong["cells"]
    assert "cells.columns" not in {problem.key for problem in physical_problems(wrong, set(), {})}
