# SPDX-License-Identifier: GPL-3.0-or-later
"""Profiles of a bed against measured points."""

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.measures.slices import boxes_around, profile
from bedchain.studies.validation import (
    BedFrames,
    compare,
    difference_metrics,
    measurement_metrics,
    profile_left_out,
    read_points,
    rms,
)
from bedchain.uncertainty.bands import STUDENT, block_band

RADIUS = 6e-4


def beads(number, seed=3):
    rng = np.random.default_rng(seed)
    return rng.uniform(0, 0.044, number), rng.uniform(0, 0.05, number), rng.normal(0, 0.2, number)


def test_no_particle_means_voidage_one_and_no_velocity():
    boxes = boxes_around(np.array([0.02]), 2e-3, 0.02, 4e-3, 0.044, 0.01)
    nothing = np.zeros((4, 2, 1))
    assert profile_left_out("voidage_1", nothing, boxes)[0] == 1.0
    assert np.isnan(profile("particle_velocity_m_s", nothing[0], boxes)).all()


def test_the_band_of_independent_frames_is_that_of_their_mean():
    rng = np.random.default_rng(8)
    boxes = boxes_around(np.array([0.02]), 2e-3, 0.02, 4e-3, 0.044, 0.01)
    solids = rng.normal(4e-8, 1e-8, (400, 2, 1))
    value, left_out = profile_left_out("voidage_1", solids, boxes)
    expected = 1e-8 / np.sqrt(400) / boxes.volumes_m3[0]
    low, high = block_band(value, left_out)
    # four degrees of freedom know an error to a third
    assert (high - low) / 2 == pytest.approx(STUDENT * expected, rel=0.7)


def test_a_bed_compared_with_itself_differs_by_nothing_and_with_a_shift_by_the_shift():
    rng = np.random.default_rng(2)
    frames = np.stack(
        [np.stack([*beads(2000, seed)[:2], np.zeros(2000), rng.normal(0.1, 0.3, 2000)]) for seed in range(6)]
    )
    bed = BedFrames(frames, 0.025, RADIUS, 0.044, 0.01)
    x = np.array([0.005, 0.02, 0.035])
    points = pd.concat(
        pd.DataFrame({"quantity": name, "height_m": height, "position_x_m": x, "value": 0.0})
        for name in ("voidage_1", "particle_velocity_m_s")
        for height in (0.015, 0.03)
    )
    table, _ = compare(points, bed)
    points["value"] = table["simulated"].to_numpy() + np.where(points["quantity"] == "voidage_1", 0.03, 0.0)
    _, metrics = compare(points, bed)
    found = metrics.set_index("quantity")["value"]
    assert found["voidage_error_rms"] == pytest.approx(0.03)
    assert found["voidage_error_mean"] == pytest.approx(-0.03)
    assert found["voidage_15_mm_error_rms"] == pytest.approx(0.03)
    assert found["particle_velocity_error_rms"] == pytest.approx(0.0, abs=1e-12)


def test_asymmetry_and_flux_of_a_measurement_by_hand():
    x = np.array([0.01, 0.03])
    rows = [
        ("voidage_1", 0.01, x, np.array([0.5, 0.5])),
        ("particle_velocity_m_s", 0.02, x, np.array([-0.1, 0.3])),
    ]
    points = pd.concat(
        pd.DataFrame({"quantity": name, "height_m": height, "position_x_m": at, "value": value})
        for name, height, at, value in rows
    )
    metrics = measurement_metrics(points, 0.04).set_index("quantity")["value"]
    assert metrics["voidage_asymmetry_rms"] == 0
    assert metrics["particle_velocity_asymmetry_rms"] == pytest.approx(0.2)
    # half solids, -0.1 m/s up to 1 cm, 0.3 m/s from 3 cm on, linear between: the mean velocity is 0.1 m/s
    assert metrics["solids_flux_20_mm"] == pytest.approx(0.05, rel=1e-3)
    sizes = 0.25 * 0.1 + 0.25 * 0.3 + 0.5 * (0.25 * 0.05 + 0.75 * 0.15)
    assert metrics["solids_flux_20_mm_size"] == pytest.approx(0.5 * sizes, rel=1e-3)
    without = measurement_metrics(points[points["quantity"] != "voidage_1"], 0.04)
    assert list(without["quantity"]) == ["particle_velocity_asymmetry_rms"]


def test_rms_and_its_band_by_hand():
    assert rms(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5))
    drawn = np.array([[1.9, 1.9], [1.95, 1.95], [2.0, 2.0], [2.05, 2.05], [2.1, 2.1]])
    rows = difference_metrics("voidage", "1", np.array([2.0, 2.0]), drawn, np.array([0.0, 0.0]))
    assert rows[0]["value"] == 2.0 and 1.0 < rows[0]["ci_low"] < rows[0]["ci_high"] < 3.0
    assert rows[1]["quantity"] == "voidage_error_mean"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("quantity,height_m,value\nvoidage_1,0.01,0.5\n", "lacks the columns position_x_m"),
        ("quantity,height_m,position_x_m,value\nheat,0.01,0.01,0.5\n", "unknown quantity heat"),
        (
            "quantity,height_m,position_x_m,value\nvoidage_1,0.01,0.01,high\n",
            "row 1 of the points is no number",
        ),
        ("quantity,height_m,position_x_m,value\n", "row 1"),
    ],
)
def test_bad_points_are_refused(tmp_path, text, said):
    file = tmp_path / "measured.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=said):
        read_points(file)


def test_a_case_without_points_is_told_so(tmp_path):
    with pytest.raises(UserError, match="no measured points"):
        read_points(tmp_path / "measured.csv")


def test_a_quantity_that_is_missing_beside_one_of_another_name_is_named(tmp_path):
    file = tmp_path / "measured.csv"
    file.write_text("quantity,height_m,position_x_m,value\n,0.01,0.02,0.5\nvoidge,0.01,0.02,0.5\n")
    with pytest.raises(UserError, match="unknown quantity nan, voidge"):
        read_points(file)
