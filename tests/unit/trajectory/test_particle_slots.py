# SPDX-License-Identifier: GPL-3.0-or-later
"""Slots of particles: one that comes back has its old one, a new one the next, and ids keep their meaning."""

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.bed_frames import BedFrame, Placement
from bedchain.trajectory.frame_files import Entry
from bedchain.trajectory.particle_slots import ParticleSlots

PLACE = Placement("x", "z", (0.0, 0.0, 0.0), 1.0, 1.0)
OPEN = Placement("x", "z", (0.0, 0.0, 0.0), 1.0, 1.0, outside="exit")
ENTRY = Entry("f", 0, 7, 0.0, None)


def frame(*ids: int, kind=None, radius_m=None) -> BedFrame:
    """A frame whose particles are at x = id / 10."""
    values = np.array(ids) / 10
    return BedFrame(np.array(ids), np.tile(values, (4, 1)), kind, radius_m)


def test_a_particle_keeps_its_slot_and_a_new_one_gets_the_next():
    slots = ParticleSlots(OPEN)
    rows = [slots.add(ENTRY, frame(*ids))[0].tolist() for ids in ((2, 5), (1, 5), (1, 2, 5))]
    assert rows[0] == [0.2, 0.5] and rows[2] == [0.2, 0.5, 0.1]
    assert np.isnan(rows[1][0]) and rows[1][1:] == [0.5, 0.1]
    assert (slots.lost, slots.gained, slots.complete) == (1, 1, False)
    assert slots.particles().ids.tolist() == [1, 2, 5]


def test_particles_that_come_and_go_are_named_where_they_are_refused():
    slots = ParticleSlots(PLACE)
    slots.add(ENTRY, frame(2, 5))
    with pytest.raises(UserError, match=r"f, step 7: other .*missing: id 2; new: id 1\); .*outside: exit"):
        slots.add(ENTRY, frame(1, 5))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": np.array([1, 2])}, "the type of a particle has changed: id 5"),
        ({"radius_m": np.array([0.1, 0.3])}, "the radius of a particle has changed, .*id 5"),
    ],
)
def test_an_id_that_means_another_particle_is_refused(change, message):
    slots = ParticleSlots(PLACE)
    slots.add(ENTRY, frame(2, 5, kind=np.array([1, 1]), radius_m=np.array([0.1, 0.1])))
    with pytest.raises(UserError, match=message):
        slots.add(ENTRY, frame(2, 5, **change))
