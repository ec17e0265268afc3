# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame in the bed's axes: order of ids, and what is done where there are none."""

from dataclasses import replace

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.bed_frames import Placement, bed_frame
from bedchain.trajectory.frame_files import FrameSettings

PLACE = Placement("x", "z", (0.0, 0.0, 1.0), 1.0, 1.0)
FILES = FrameSettings("*")
VALUES = {"x": np.array([0.1, 0.3]), "z": np.array([1.5, 1.7])}


def test_particles_are_in_the_order_of_their_ids():
    frame = bed_frame(VALUES | {"id": np.array([9.0, 4.0]), "type": np.array([1, 2])}, FILES, PLACE, "f")
    assert frame.ids.tolist() == [4, 9] and frame.type.tolist() == [2, 1]
    assert (
        frame.rows[:2] == pytest.approx(np.array([[0.3, 0.1], [0.7, 0.5]])) and np.isnan(frame.rows[2:]).all()
    )
    with pytest.raises(UserError, match="f: the id 4.5 is not a whole number"):
        bed_frame(VALUES | {"id": np.array([9.0, 4.5])}, FILES, PLACE, "f")
    with pytest.raises(UserError, match="f: there is no position z; there are x"):
        bed_frame({"x": VALUES["x"]}, FILES, PLACE, "f")


def test_a_particle_beyond_a_periodic_side_is_put_back_at_the_other_one():
    placement = replace(PLACE, periods_m=(0.25, 0.0, 0.0))
    frame = bed_frame(VALUES | {"id": np.array([1, 2])}, FILES, placement, "f")
    assert frame.rows[:2] == pytest.approx(np.array([[0.1, 0.05], [0.5, 0.7]]))


def test_without_ids_a_frame_is_refused_or_in_order_or_of_one_tracer():
    with pytest.raises(UserError, match="no column of ids, .* say frames.without_ids: order"):
        bed_frame(VALUES, FILES, PLACE, "f")
    assert bed_frame(VALUES, FILES, replace(PLACE, without_ids="order"), "f").ids.tolist() == [1, 2]
    tracer = bed_frame(VALUES, FILES, replace(PLACE, without_ids="one_tracer"), "f")
    assert tracer.ids.tolist() == [1] and tracer.rows[:2, 0] == pytest.approx([0.2, 0.6])
