# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing of marked groups: share that is still on its side, and Lacey's index."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.measures.cell_shares import shares_inside
from bedchain.trajectory.grid import Grid

# (direction, group), in the order of all arrays with an axis of 4
GROUPS = (("radial", "left"), ("radial", "right"), ("axial", "low"), ("axial", "up"))


class Splits(NamedTuple):
    """Lines at which the marked groups meet.

    Attributes
    ----------
    split_x_m, split_z_m : float
        Between left and right, and between low and up [m].
    """

    split_x_m: float
    split_z_m: float


def sides(
    x_m: NDArray[np.floating], z_m: NDArray[np.floating], split_x_m: float, split_z_m: float
) -> NDArray[np.bool_]:
    """Particles that are left, right, low and up.

    Parameters
    ----------
    x_m, z_m : (..., n_particles) array
        Positions [m].
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m]; a particle on a line is right or up.

    Returns
    -------
    (4, ..., n_particles) bool array
        In the order of `GROUPS`.
    """
    # a particle that is not in the frame (NaN) is on no side
    return np.stack((x_m < split_x_m, x_m >= split_x_m, z_m < split_z_m, z_m >= split_z_m))


def side_shares(grid: Grid, split_x_m: float, split_z_m: float) -> NDArray[np.float64]:
    """Share of each cell that lies on each side.

    A cell that a line divides counts with the share of its area (or volume) on each side, as if its particles
    were evenly spread: a chain of cells does not know where they are in the cell.

    Parameters
    ----------
    grid : Grid
        The cells.
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m]; inside the bed.

    Returns
    -------
    (4, n_cells) array
        In the order of `GROUPS`; left + right = low + up = 1.

    Raises
    ------
    DataError
        A line lies outside the bed.
    """
    for name, split, size in (("x", split_x_m, grid.width_m), ("z", split_z_m, grid.height_m)):
        if not 0 < split < size:
            raise DataError(
                f"the split at {name} = {split:g} m leaves one side empty: choose 0 to {size:g} m"
            )
    if grid.form != "boxes":
        of_left = shares_inside(grid, lambda x, z, y: x < split_x_m)
        of_low = shares_inside(grid, lambda x, z, y: z < split_z_m)
        return np.stack((of_left, 1 - of_left, of_low, 1 - of_low))
    left = np.clip((split_x_m - grid.x_edges_m[:-1]) / grid.cell_width_m, 0.0, 1.0)
    low = np.clip((split_z_m - grid.z_edges_m[:-1]) / grid.cell_height_m, 0.0, 1.0)
    # a line on an edge, up to round-off, divides no cell
    left, low = (np.where(np.abs(s - np.round(s)) < 1e-9, np.round(s), s) for s in (left, low))
    of_left = np.tile(left, grid.rows * grid.layers)
    of_low = np.tile(np.repeat(low, grid.columns), grid.layers)
    return np.stack((of_left, 1 - of_left, of_low, 1 - of_low))


def remaining_from_positions(
    x_m: NDArray[np.floating], z_m: NDArray[np.floating], split_x_m: float, split_z_m: float
) -> NDArray[np.float64]:
    """Share of each group, marked in the first frame, that is on its side in each frame (Fig. 5, DEM).

    Of particles that come and go (NaN where they are not there), the share of those that are still there.

    Parameters
    ----------
    x_m, z_m : (n_frames, n_particles) array
        Positions [m].
    split_x_m, split_z_m : float
        As `sides`.

    Returns
    -------
    (n_frames, 4) array
        1 in the first frame; NaN for a group without particles.
    """
    marked = sides(np.asarray(x_m[0]), np.asarray(z_m[0]), split_x_m, split_z_m)
    remaining = np.empty((len(x_m), 4))
    for frame in range(len(x_m)):
        now = sides(np.asarray(x_m[frame]), np.asarray(z_m[frame]), split_x_m, split_z_m)
        seen = marked & (now[0] | now[1])
        remaining[frame] = _mean_of(seen, (marked & now).sum(axis=1))
    return remaining


def remaining_from_cells(
    cells: NDArray[np.int32], marked: NDArray[np.bool_], shares: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The curves of `remaining_from_positions` from cells alone, for comparison with a chain of cells.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle.
    marked : (4, n_particles) bool array
        Groups, in the order of `GROUPS` (from `sides`).
    shares : (4, n_cells) array
        From `side_shares`.

    Returns
    -------
    (n_frames, 4) array
        Shares [1]; less than 1 in the first frame where a line divides cells.
    """
    remaining = np.empty((len(cells), 4))
    for frame in range(len(cells)):
        held = marked_histogram(np.asarray(cells[frame]), marked, shares.shape[1])
        remaining[frame] = _mean_of(marked, (held * shares).sum(axis=1))
    return remaining


def _mean_of(marked: NDArray[np.bool_], total: NDArray[np.generic]) -> NDArray[np.float64]:
    size = marked.sum(axis=1)
    return np.divide(total, size, out=np.full(4, np.nan), where=size > 0)


def marked_histogram(
    states: NDArray[np.integer], marked: NDArray[np.bool_], n_states: int
) -> NDArray[np.int64]:
    """Particles of each group in each state.

    Parameters
    ----------
    states : (n_particles,) int array
        State (or cell) of each particle; negative for one that is not there, which is not counted.
    marked : (n_groups, n_particles) bool array
        Groups.
    n_states : int
        Number of states.

    Returns
    -------
    (n_groups, n_states) int64 array
        Counts [1].
    """
    place = np.where(states >= 0, states, n_states)  # those that are not there behind the last state
    # groups as weights: a third of the time of a bincount of each group's particles
    counts = [np.bincount(place, group, n_states + 1)[:n_states] for group in marked]
    return np.stack(counts).astype(np.int64)


def lacey_index(marked: NDArray[Any], total: NDArray[Any]) -> float:
    """Lacey's mixing index of a marked group over cells: 0 separated, 1 a random mixture (expected value).

    ``M = (s0^2 - s^2) / (s0^2 - sr^2)`` with the variance s^2 of the marked share over the cells weighted
    by their particles, ``s0^2 = c (1 - c)`` and ``sr^2 = c (1 - c) / n`` for n particles a cell (Lacey
    1954).

    Parameters
    ----------
    marked, total : (n_cells,) array
        Marked and all particles in each cell [1]; empty cells do not count.

    Returns
    -------
    float
        Index [1]; NaN where all or no particles are marked or every cell holds one particle.
    """
    held = total > 0
    n = np.asarray(total[held], float)
    share = np.asarray(marked[held], float) / n
    c = float((share * n).sum() / n.sum())
    separated = c * (1 - c)
    random_mixture = separated * held.sum() / n.sum()
    if separated <= 0 or separated <= random_mixture:
        return float("nan")
    variance = float((n * (share - c) ** 2).sum() / n.sum())
    return (separated - variance) / (separated - random_mixture)
