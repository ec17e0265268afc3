# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the gas and its steps, each refused with key, line and remedy."""

import pytest

from bedchain.case.gas_checks import DRAG_LAG_MAX, drag_follows_collisions
from bedchain.case.parameters import SKIN_MOST
from bedchain.physics.packing import PACKED_VOLUME_SHARE
from bedchain.studies.verification.laws import (
    Suspension,
    drag_coefficient,
    ergun_beta,
    minimum_fluidization,
)
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


def test_a_gas_step_is_refused_where_drag_lags_behind_collisions():
    sand = Suspension(1e-4, 2600, 1.2, 1.8e-5)
    voidage = 1 - PACKED_VOLUME_SHARE
    slip = minimum_fluidization(sand, voidage) / voidage
    rate = drag_coefficient(ergun_beta, sand, voidage, slip) / sand.mass  # K/m [1/s]
    limit = 2 * DRAG_LAG_MAX / rate
    scene = (1e-4, 2600, 1.2, 1.8e-5, 1e-3, "many")
    assert not list(drag_follows_collisions(0.99 * limit, *scene))
    [(key, wrong, remedy)] = drag_follows_collisions(1.01 * limit, *scene)
    assert key == "time.gas_step_s" and "dt K/m / 2" in wrong and "take at most" in remedy


def test_no_particle_crosses_a_gas_cell_before_its_rank_is_known(tmp_path):
    # Within a skin of neighbours a particle may be beyond the slab of its rank
    assert SKIN_MOST < 1
    narrow = ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  cell_size_m: 9e-4")
    assert_refused(changed_case(tmp_path, narrow), "gas.cell_size_m", "smaller than a particle")
