# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of columns in files of other programs, and positions as shares of a box."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.raw import our_columns, unscaled


@pytest.mark.parametrize(
    ("names", "places"),
    [
        ("id type x y z vx vy vz radius", {"id": 0, "type": 1, "x": 2, "vz": 7, "radius": 8}),
        ("id xs ys zs", {"id": 0, "x": 1, "z": 3}),
        ("X,Y,Z,phase_id,diameter,density,U,V,W,t_s", {"x": 0, "type": 3, "diameter": 4, "vx": 6, "vy": 7}),
        ("Particle ID,Position X (m),Position Y (m),Velocity X (m/s)", {"id": 0, "x": 1, "y": 2, "vx": 3}),
        ("t x y z error", {"time": 0, "x": 1, "z": 3}),
        ("time [s],id,x_m,z_m,vx_m_s", {"time": 0, "id": 1, "x": 2, "z": 3, "vx": 4}),
    ],
)
def test_columns_of_other_programs_are_recognised(names, places):
    found = our_columns(names.split("," if "," in names else " "))
    assert places.items() <= found.items()


def test_a_speed_is_no_component_and_a_temperature_no_time():
    assert "vy" not in our_columns(["id", "x", "v"]) and "time" not in our_columns(["x", "t_s"])


def test_a_renamed_column_goes_before_a_guess_and_must_be_there():
    assert our_columns(["x", "depth"], {"z": "depth"}) == {"x": 0, "z": 1}
    with pytest.raises(DataError, match=r"no column 'height' for z \(frames.columns\); there are x depth"):
        our_columns(["x", "depth"], {"z": "height"})


def test_scaled_positions_become_lengths_and_need_a_box():
    box = np.array([[1.0, 3.0], [0, 1], [0, 1]])
    assert unscaled({"x": np.array([0.5])}, ["xs"], box)["x"] == [2.0]
    assert unscaled({"x": np.array([0.5])}, ["x", "xs"], box)["x"] == [0.5]
    with pytest.raises(DataError, match="shares of a box"):
        unscaled({"x": np.array([0.5])}, ["xs"], None)
