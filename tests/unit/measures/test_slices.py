# SPDX-License-Identifier: GPL-3.0-or-later
"""Profiles of slices: shares of spheres against integrals and points, averages against loops."""

import numpy as np
import pytest

from bedchain.measures.slices import boxes_around, profile, share_between, solids_in_boxes

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
