# SPDX-License-Identifier: GPL-3.0-or-later
"""First cases: what they say of sound frames, of millimetres, of two runs in one folder, and refusals."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from bedchain.errors import UserError
from bedchain.trajectory.first_case import first_case
from bedchain.trajectory.frame_files import FrameSettings
from made.forms import BOX, STEP_S, moving, write_form

SERIES = moving(n_frames=20, n_particles=60)


def case_of(pattern, **more):
    return yaml.safe_load(first_case(FrameSettings(str(pattern), **more), Path(), "frames").text)


@pytest.mark.parametrize("form", ["text", "vtk"])
def test_the_step_is_estimated_and_the_bed_measured(tmp_path, form):
    case = case_of(write_form(form, tmp_path, SERIES))
    assert case["frames"]["step_s"] == pytest.approx(STEP_S)
    assert case["frames"]["origin_m"] == pytest.approx(BOX[:, 0], abs=5e-3)
    assert case["bed"] == pytest.approx({"width_m": 0.1, "height_m": 0.2}, abs=5e-3)
    assert case["particles"] == {"diameter_m": 0.001}
    assert case["learning"] == {"start_s": 0.02, "end_s": 0.1} and case["comparison"]["end_s"] == 0.19
    rows = case["cells"]["rows"] * case["mixing"]["split_z_m"] / case["bed"]["height_m"]
    assert rows == pytest.approx(round(rows), abs=1e-4)


def test_millimetres_are_told(tmp_path):
    scaled = SERIES._replace(
        positions=SERIES.positions * 1e3, velocities=SERIES.velocities * 1e3, radii=SERIES.radii * 1e3
    )
    case = case_of(write_form("table", tmp_path, scaled))
    assert case["frames"]["length_unit_m"] == 0.001 and case["particles"] == {"diameter_m": 0.001}
    assert case["bed"]["height_m"] == pytest.approx(0.2, abs=5e-3)


def test_of_two_runs_the_longer_is_taken(tmp_path):
    other = moving(n_frames=6, n_particles=60, seed=9)
    both = SERIES._replace(
        positions=np.concatenate((SERIES.positions, other.positions)),
        velocities=np.concatenate((SERIES.velocities, other.velocities)),
        steps=np.arange(26) * 1000,
    )
    case = case_of(write_form("text", tmp_path, both))
    assert case["frames"]["last_step"] == 19000 and "first_step" not in case["frames"]


def test_frames_without_ids_say_what_that_means(tmp_path):
    for frame in range(9):
        rows = "\n".join(",".join(map(str, row)) for row in SERIES.positions[frame][:, [0, 2]])
        (tmp_path / f"f{frame}.csv").write_text("x,z\n" + rows + "\n")
    text = first_case(FrameSettings(f"{tmp_path}/*", step_s=0.1), Path(), "frames").text
    assert "without_ids: order  # no ids" in text and "a guess" in text


def test_a_track_gets_even_times_few_cells_and_the_units_of_tracks(tmp_path):
    """Locations of one tracer in mm and ms, out of order, two of them at one time, as PEPT gives them."""
    rng, number = np.random.default_rng(1), 150
    places = 100 + 15 * np.sin(np.cumsum(rng.normal(0, 0.4, (number, 3)), axis=0))
    times = np.cumsum(rng.uniform(5, 25, number))
    times[7] = times[6]
    rows = rng.permutation(np.column_stack((times, places, rng.random(number))))
    lines = "\n".join(" ".join(f"{value:.18e}" for value in row) for row in rows)
    (tmp_path / "track.csv").write_text("# t x y z error\n" + lines + "\n")
    case = case_of(tmp_path / "track.csv")
    assert case["frames"] | {"files": "", "origin_m": []} == {
        "files": "", "origin_m": [], "length_unit_m": 0.001, "time_unit_s": 0.001, "every_s": 0.02,
        "without_ids": "one_tracer", "up": "z", "across": "x",
    }  # fmt: skip
    assert case["bed"]["width_m"] == pytest.approx(0.03, abs=5e-3) and "outside" not in case
    assert case["cells"]["columns"] * case["cells"]["rows"] <= 20
    assert 0 < case["mixing"]["split_z_m"] < case["bed"]["height_m"]
    assert case["comparison"]["end_s"] <= (times.max() - times.min()) / 1000


def test_what_cannot_be_a_case_is_refused(tmp_path):
    pattern = write_form("text", tmp_path, moving(n_frames=5))
    with pytest.raises(UserError, match="5 frames of 20 particles; at least 9"):
        case_of(pattern)
    still = SERIES._replace(velocities=0 * SERIES.velocities)
    with pytest.raises(UserError, match="no velocities to estimate them by: give --step_s"):
        case_of(write_form("many_text", tmp_path / "still", still))
