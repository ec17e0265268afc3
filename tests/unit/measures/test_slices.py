# SPDX-License-Identifier: GPL-3.0-or-later
"""Profiles of slices: shares of spheres against integrals and points, averages against loops."""

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.measures.slices import boxes_around, profile, share_between, solids_in_boxes
from bedchain.studies.validation import (
    BedFrames,
    compare,
    difference_metrics,
    profile_with_band,
    read_points,
    rms,
)

RADIUS = 6e-4
VOLUME = 4 / 3 * np.pi * RADIUS**3
DISCS = 20000  # of the integral of a sphere
DISC_ERROR = 1e-7  # of a midpoint sum over as many
POINT_ERROR = 2e-2  # of shares counted with points in a sphere


def beads(number, seed=3):
    rng = np.random.default_rng(seed)
    return rng.uniform(0, 0.044, number), rng.uniform(0, 0.05, number), rng.normal(0, 0.2, number)


@pytest.mark.parametrize(("low", "high"), [(-1.0, 1.0), (-0.3, 0.55), (0.2, 5.0), (-7.0, -0.9)])
def test_share_between_planes_is_the_integral_of_discs(low, high):
    z = (np.arange(DISCS) + 0.5) / DISCS * 2 - 1
    inside = (z > low) & (z < high)
    by_discs = 0.75 * ((1 - z**2) * inside).sum() * 2 / DISCS
    share = share_between(
        np.array(0.01), RADIUS, np.array(0.01 + low * RADIUS), np.array(0.01 + high * RADIUS)
    )
    assert share == pytest.approx(by_discs, abs=1 / DISCS if abs(low) < 1 else DISC_ERROR)


def test_boxes_that_fill_the_bed_hold_every_sphere_once():
    x, z, vz = beads(500)
    x, z = np.clip(x, RADIUS, 0.044 - RADIUS), np.clip(z, RADIUS, 0.05 - RADIUS)
    edges = np.linspace(0, 0.044, 12)
    boxes = boxes_around((edges[1:] + edges[:-1]) / 2, 0.004, 0.025, 0.05, 0.044, 0.01)
    volume, momentum = solids_in_boxes(x, z, vz, RADIUS, boxes)
    assert volume.sum() == pytest.approx(500 * VOLUME, rel=1e-12)
    assert momentum.sum() == pytest.approx(VOLUME * vz.sum(), rel=1e-9)


def test_solids_are_those_of_a_loop_over_particles_and_boxes():
    x, z, vz = beads(300)
    positions = np.array([0.0009, 0.02, 0.0437])
    boxes = boxes_around(positions, 1.9e-3, 0.0164, 4e-3, 0.044, 0.01)

    def below(plane, centre):
        t = min(1.0, max(-1.0, (plane - centre) / RADIUS))
        return (2 + 3 * t - t**3) / 4

    expected = np.zeros((2, 3))
    for box, position in enumerate(positions):
        left, right = max(0.0, position - 0.95e-3), min(0.044, position + 0.95e-3)
        for i in range(300):
            across = below(right, x[i]) - below(left, x[i])
            up = below(0.0184, z[i]) - below(0.0144, z[i])
            expected[0, box] += VOLUME * across * up
            expected[1, box] += VOLUME * across * up * vz[i]
    np.testing.assert_allclose(solids_in_boxes(x, z, vz, RADIUS, boxes), expected, rtol=1e-12, atol=1e-25)


def test_a_sphere_cut_twice_counts_its_true_volume_on_average_over_heights():
    rng = np.random.default_rng(5)
    points = rng.uniform(-RADIUS, RADIUS, (400_000, 3))
    points = points[(points**2).sum(axis=1) < RADIUS**2]
    heights = np.linspace(0.0164 - 0.002 - RADIUS, 0.0164 + 0.002 + RADIUS, 41)
    x = np.full(len(heights), 0.0203)
    boxes = boxes_around(np.array([0.02]), 1e-3, 0.0164, 4e-3, 0.044, 0.01)
    found = sum(
        solids_in_boxes(x[i : i + 1], heights[i : i + 1], x[:1], RADIUS, boxes)[0, 0] for i in range(41)
    )
    inside = np.abs(0.0203 + points[:, 0] - 0.02) < 0.5e-3
    counted = sum((inside & (np.abs(height + points[:, 2] - 0.0164) < 2e-3)).mean() for height in heights)
    assert found == pytest.approx(VOLUME * counted, rel=POINT_ERROR)


def test_a_strip_at_the_wall_ends_there():
    boxes = boxes_around(np.array([0.0009, 0.0437]), 1.9e-3, 0.02, 4e-3, 0.044, 0.01)
    np.testing.assert_allclose(boxes.x_low_m, [0, 0.04275])
    np.testing.assert_allclose(boxes.x_high_m, [0.00185, 0.044])
    np.testing.assert_allclose(boxes.volumes_m3, [0.00185 * 4e-5, 0.00125 * 4e-5])


def test_velocity_is_the_mean_over_particles_and_not_over_frames():
    boxes = boxes_around(np.array([0.02]), 8e-3, 0.02, 8e-3, 0.044, 0.01)
    three = solids_in_boxes(np.full(3, 0.02), np.full(3, 0.02), np.full(3, 0.1), RADIUS, boxes)
    one = solids_in_boxes(np.full(1, 0.02), np.full(1, 0.02), np.full(1, -0.3), RADIUS, boxes)
    mean = np.stack([three, one]).mean(axis=0)
    assert profile("particle_velocity_m_s", mean, boxes)[0] == pytest.approx(0.0, abs=1e-15)
    assert profile("voidage_1", mean, boxes)[0] == pytest.approx(1 - 2 * VOLUME / (8e-3 * 8e-3 * 0.01))


def test_no_particle_means_voidage_one_and_no_velocity():
    boxes = boxes_around(np.array([0.02]), 2e-3, 0.02, 4e-3, 0.044, 0.01)
    nothing = np.zeros((4, 2, 1))
    assert profile_with_band("voidage_1", nothing, boxes, 2)[0] == 1.0
    assert np.isnan(profile("particle_velocity_m_s", nothing[0], boxes)).all()


def test_the_band_of_independent_frames_is_that_of_their_mean():
    rng = np.random.default_rng(8)
    boxes = boxes_around(np.array([0.02]), 2e-3, 0.02, 4e-3, 0.044, 0.01)
    solids = rng.normal(4e-8, 1e-8, (400, 2, 1))
    _, replicates = profile_with_band("voidage_1", solids, boxes, 1)
    expected = 1e-8 / np.sqrt(400) / boxes.volumes_m3[0]
    assert replicates.std() == pytest.approx(expected, rel=0.2)


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


def test_rms_and_its_band_by_hand():
    assert rms(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5))
    drawn = np.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]])
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
