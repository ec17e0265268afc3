# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres at the start of a check: lattices, and the voidage of a bed of spheres."""

import numpy as np


def lattice(width: float, height: float, spacing: float, diameter: float) -> np.ndarray:
    """Square lattice that fills a box up to its walls.

    Returns
    -------
    (n, 5) ndarray
        x, z [m], vx, vz [m/s] = 0, diameter [m].
    """
    columns, rows = round(width / spacing), round(height / spacing)
    z, x = np.meshgrid((np.arange(rows) + 0.5) * spacing, (np.arange(columns) + 0.5) * spacing, indexing="ij")
    return spheres_at_rest(x.ravel(), z.ravel(), diameter)


def spheres_at_rest(x: np.ndarray, z: np.ndarray, diameter: float) -> np.ndarray:
    """Spheres at rest at given positions [m], as rows of x, z, vx, vz, diameter."""
    still = np.zeros_like(x)
    return np.column_stack([x, z, still, still, np.full_like(x, diameter)])


def loose_lattice(width: float, number: int, diameter: float, rng: np.random.Generator) -> np.ndarray:
    """Lattice without contacts and with random velocities; it settles into a random packing."""
    columns = int(width / (1.15 * diameter))
    spacing = width / columns
    rows = -(-number // columns)
    spheres = lattice(width, rows * spacing, spacing, diameter)[:number]
    spheres[:, 2:4] = rng.uniform(-0.1, 0.1, (number, 2))
    return spheres


def rows_of_voidage(z: np.ndarray, diameter: float, edges: np.ndarray, row_section: float) -> np.ndarray:
    """Voidage of horizontal rows; spheres are divided exactly at the planes between them.

    Parameters
    ----------
    z : (n,) ndarray
        Heights of the centres [m].
    diameter : float
        Of the spheres [m].
    edges : (n_rows + 1,) ndarray
        Planes [m].
    row_section : float
        Width times thickness of the slab [m2].
    """
    radius = diameter / 2
    # volume of a sphere below a plane at a height h above its lowest point: pi h^2 (r - h/3)
    depth = np.clip(edges[:, None] - (z[None, :] - radius), 0, diameter)
    below = (np.pi * depth**2 * (radius - depth / 3)).sum(axis=1)
    return np.asarray(1 - np.diff(below) / (row_section * np.diff(edges)))


def bulk_voidage(spheres_z: np.ndarray, diameter: float, section: float) -> float:
    """Voidage of a settled bed from one diameter above its bottom to three below its top.

    Parameters
    ----------
    spheres_z : (n,) ndarray
        Heights of the centres [m].
    diameter : float
        Of the spheres [m].
    section : float
        Width times thickness of the slab [m2].
    """
    # 2 % of the spheres may lie singly above the surface
    top = float(np.quantile(spheres_z, 0.98))
    edges = np.array([diameter, top - 3 * diameter])
    return float(rows_of_voidage(spheres_z, diameter, edges, section)[0])
