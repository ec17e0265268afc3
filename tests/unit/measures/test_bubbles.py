# SPDX-License-Identifier: GPL-3.0-or-later
"""Bubbles of known size and speed: discs that rise through a dense bed below a freeboard."""

import numpy as np
import pytest

from bedchain.measures.bubbles import bubble_table, by_height, rises, voidage_maps
from bedchain.measures.voidage import Slab

CELL, INTERVAL, VOID = 0.005, 0.025, 0.7
PLACE = (np.arange(80) + 0.5) * CELL
X, Z = np.meshgrid(PLACE[:40], PLACE)


def bed(discs):
    """Voidage with discs (x, z, diameter) [m]; freeboard above 0.3 m."""
    voidage = np.where(Z > 0.3, 1.0, 0.45)
    for x, z, diameter in discs:
        voidage[np.hypot(X - x, Z - z) < diameter / 2] = 0.95
    return voidage


def test_size_and_speed_of_two_rising_discs():
    # 0.8 and 1.2 m/s: 2 and 3 cm a frame
    frames = [bed([(0.05, 0.05 + 0.02 * at, 0.04), (0.15, 0.05 + 0.03 * at, 0.05)]) for at in range(6)]
    table = bubble_table(frames, CELL, VOID)
    assert len(table) == 12
    np.testing.assert_allclose(np.sort(table["diameter_m"].unique()), [0.04, 0.05], rtol=0.03)
    risen = rises(table, INTERVAL, 2.0)
    assert len(risen) == 10
    speed = risen.groupby(risen["diameter_m"] > 0.045)["velocity_m_s"].mean()
    np.testing.assert_allclose(speed, [0.8, 1.2], rtol=0.03)
    rows = by_height(table, risen, np.array([0.1, 0.12]), 5 * INTERVAL)
    assert rows.loc[0, "frequency_Hz"] == pytest.approx(2 / (5 * INTERVAL))  # both pass 0.11 m
    assert np.isnan(rows.loc[0, "diameter_m"])  # of fewer than five bubbles there is no mean


def test_the_freeboard_and_a_bubble_open_to_it_are_none():
    assert bubble_table([bed([]), bed([(0.1, 0.3, 0.06)])], CELL, VOID).empty


def test_gaps_between_particles_are_none():
    voidage = bed([])
    voidage[10, 10:13] = 0.9
    assert bubble_table([voidage], CELL, VOID).empty
    voidage[11, 10] = 0.9
    assert len(bubble_table([voidage], CELL, VOID)) == 1


def test_what_jumps_or_sinks_is_not_the_same_bubble():
    frames = [bed([(0.05, 0.1, 0.04)]), bed([(0.05, 0.08, 0.04)]), bed([(0.15, 0.12, 0.04)])]
    frames += [bed([(0.15, 0.16, 0.08)])]  # four times the area
    assert rises(bubble_table(frames, CELL, VOID), INTERVAL, 2.0).empty


def test_voidage_of_a_frame_counts_the_particles_of_each_cell():
    x, z = np.array([0.1, 0.1, 1.9]), np.array([0.1, 0.2, 2.9])
    slab = Slab(10 * np.pi / 6, 1.0)  # a sphere takes a tenth of a cell
    (voidage,) = voidage_maps([np.array([x, z])], (3.0, 2.0), 1.0, slab)
    np.testing.assert_allclose(voidage, [[0.8, 1], [1, 1], [1, 0.9]])
