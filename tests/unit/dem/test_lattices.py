# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices, loose heaps, and the voidage of spheres cut by planes."""

import numpy as np
import pytest

from bedchain.dem.lattices import bulk_voidage, lattice, loose_lattice, rows_of_voidage, spheres_at_rest

DIAMETER = 1e-3


def test_a_lattice_fills_its_box_up_to_the_walls():
    spheres = lattice(0.004, 0.002, DIAMETER, DIAMETER)
    assert spheres.shape == (8, 5)
    assert sorted(set(spheres[:, 0].round(9))) == [0.0005, 0.0015, 0.0025, 0.0035]
    assert sorted(set(spheres[:, 1].round(9))) == [0.0005, 0.0015]
    assert (spheres[:, 2:] == [0, 0, DIAMETER]).all()


def test_a_loose_heap_has_as_many_spheres_apart_and_moving():
    spheres = loose_lattice(0.02, 50, DIAMETER, np.random.default_rng(1))
    gaps = np.hypot(*(spheres[:, None, :2] - spheres[None, :, :2]).transpose(2, 0, 1))
    assert len(spheres) == 50 and gaps[~np.eye(50, dtype=bool)].min() > DIAMETER
    assert spheres[:, 0].min() >= DIAMETER / 2 and spheres[:, 0].max() <= 0.02 - DIAMETER / 2
    assert 0 < np.abs(spheres[:, 2:4]).max() <= 0.1


def test_rows_hold_the_volume_of_spheres_cut_by_their_planes():
    z = np.array([0.0013, 0.0021, 0.0030])
    section, edges = 2e-6, np.array([0.0, 0.001, 0.0021, 0.004])
    voidage = rows_of_voidage(z, DIAMETER, edges, section)
    solids = (1 - voidage) * section * np.diff(edges)
    sphere = np.pi / 6 * DIAMETER**3
    assert solids.sum() == pytest.approx(3 * sphere)
    # the lowest row has a cap 0.2 mm high of the first sphere; the highest half of the second and the third
    assert solids[0] == pytest.approx(np.pi * 0.2e-3**2 * (0.5e-3 - 0.2e-3 / 3))
    assert solids[2] == pytest.approx(1.5 * sphere)


def test_the_bulk_of_a_square_lattice_has_its_voidage():
    spheres = lattice(0.02, 0.03, DIAMETER, DIAMETER)
    assert bulk_voidage(spheres[:, 1], DIAMETER, 0.02 * DIAMETER) == pytest.approx(1 - np.pi / 6, rel=0.02)


def test_spheres_at_rest_do_not_move():
    spheres = spheres_at_rest(np.array([0.1, 0.2]), np.array([0.3, 0.4]), DIAMETER)
    assert spheres.tolist() == [[0.1, 0.3, 0, 0, DIAMETER], [0.2, 0.4, 0, 0, DIAMETER]]
