# SPDX-License-Identifier: GPL-3.0-or-later
"""Bubbles of a simulated bed: their size, rise velocity and number by height, from the voidage of frames.

A bubble is a connected region (over sides of cells) of more than `void` voidage that does not reach the top
of the bed's box, and so is not the freeboard. Its diameter is that of a circle of its area.
"""

from collections.abc import Iterable, Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from bedchain.measures.voidage import Slab, cell_voidage
from bedchain.physics.bubbling_bed import MINIMUM_VOIDAGE
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.trajectory.grid import Grid

VOID = (1 + MINIMUM_VOIDAGE) / 2  # a bubble ends half way between minimum fluidization and no particles
# no bubble is taken to rise faster: times sqrt(g W), the fall through the bed's width
FASTEST = 3.0
SMALLEST_CELLS = 4  # smaller regions are gaps between particles
LARGEST_GROWTH = 2.0  # of a bubble's area from a frame to the next: beyond, it merged, split or is another
LARGEST_SIDESTEP = 0.5  # of a bubble over its rise and its radius together
SMALLEST_SAMPLE = 5  # bubbles in a row that a mean is given for
COLUMNS = ["frame", "x_m", "z_m", "diameter_m"]


def voidage_maps(
    positions_m: Iterable[NDArray], size_m: tuple[float, float], cell_m: float, slab: Slab
) -> Iterator[NDArray[np.float64]]:
    """Voidage of square cells in each frame, (rows, columns) [1].

    Parameters
    ----------
    positions_m : iterable of (>= 2, n_particles) array
        Rows x, z, ... of each frame [m].
    size_m : (float, float)
        Height and width of the bed [m].
    cell_m : float
        Edge of a cell [m].
    slab : Slab
    """
    rows, columns = (round(length / cell_m) for length in size_m)
    grid = Grid(size_m[1], size_m[0], columns, rows)
    return (cell_voidage(frame[0], frame[1], grid, slab).reshape(rows, columns) for frame in positions_m)


def followed_bubbles(
    maps: Iterable[NDArray[np.float64]], cell_m: float, interval_s: float, width_m: float
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Bubbles of voidage above `VOID`, and those that are seen again in the next frame.

    Parameters
    ----------
    maps : iterable of (rows, columns) array
        Voidage of each frame [1].
    cell_m : float
        Edge of a cell [m].
    interval_s : float
        Time between frames [s].
    width_m : float
        Of the bed [m].

    Returns
    -------
    (DataFrame, DataFrame)
        Of `bubble_table` and of `rises`.
    """
    table = bubble_table(maps, cell_m, VOID)
    return table, rises(table, interval_s, FASTEST * float(np.sqrt(GRAVITY_M_S2 * width_m)))


def bubbles_of(voidage: NDArray[np.float64], cell_m: float, void: float) -> NDArray[np.float64]:
    """Bubbles of one frame.

    Parameters
    ----------
    voidage : (rows, columns) array
        Row 0 at the bottom [1].
    cell_m : float
        Edge of a cell [m].
    void : float
        Voidage from which on a cell belongs to a bubble [1].

    Returns
    -------
    (n_bubbles, 3) ndarray
        x, z of the centre of area, and diameter [m].
    """
    labels, count = ndimage.label(voidage > void)
    area = np.bincount(labels.ravel(), minlength=count + 1)
    area[np.unique(labels[-1])] = 0  # the freeboard
    area[0] = 0
    which = np.flatnonzero(area >= SMALLEST_CELLS)
    if not len(which):
        return np.empty((0, 3))
    centres = np.array(ndimage.center_of_mass(labels > 0, labels, which)) + 0.5
    diameter = np.sqrt(4 * area[which] / np.pi)
    return cell_m * np.column_stack([centres[:, 1], centres[:, 0], diameter])


def bubble_table(maps: Iterable[NDArray[np.float64]], cell_m: float, void: float) -> pd.DataFrame:
    """Bubbles of all frames, each row with its frame: frame, x_m, z_m, diameter_m; see `bubbles_of`."""
    parts = [np.insert(bubbles_of(voidage, cell_m, void), 0, at, axis=1) for at, voidage in enumerate(maps)]
    return pd.DataFrame(np.concatenate(parts) if parts else np.empty((0, 4)), columns=COLUMNS)


def rises(table: pd.DataFrame, interval_s: float, fastest_m_s: float) -> pd.DataFrame:
    """Bubbles that are in two frames, the second time higher.

    A bubble and one of the next frame are the same where each is the nearest to the other at the place that
    the first would have reached at half of `fastest_m_s`, and neither size nor place jumps.

    Parameters
    ----------
    table : DataFrame
        Of `bubble_table`.
    interval_s : float
        Time between frames [s].
    fastest_m_s : float
        No bubble rises faster [m/s].

    Returns
    -------
    DataFrame
        frame, z_m (of the middle), from_m, to_m, diameter_m (mean), velocity_m_s.
    """
    frames = dict(tuple(table.groupby("frame")[COLUMNS[1:]]))
    pairs = [
        _same(at, before.to_numpy(), frames[at + 1].to_numpy(), interval_s, fastest_m_s)
        for at, before in frames.items()
        if at + 1 in frames
    ]
    columns = ["frame", "z_m", "from_m", "to_m", "diameter_m", "velocity_m_s"]
    return pd.DataFrame(np.concatenate(pairs) if pairs else np.empty((0, 6)), columns=columns)


def _same(
    frame: float, before: NDArray, after: NDArray, interval_s: float, fastest_m_s: float
) -> NDArray[np.float64]:
    """Rows of `rises` between two frames of (n, 3) bubbles."""
    step = fastest_m_s * interval_s
    guess = before[:, :2] + [0, step / 2]
    _, forward = cKDTree(after[:, :2]).query(guess)
    _, backward = cKDTree(guess).query(after[:, :2])
    mutual = backward[forward] == np.arange(len(before))
    start, end = before[mutual], after[forward[mutual]]
    rise, growth = end[:, 1] - start[:, 1], (end[:, 2] / start[:, 2]) ** 2
    aside = np.abs(end[:, 0] - start[:, 0])
    kept = (rise > 0) & (rise < step) & (growth < LARGEST_GROWTH) & (growth > 1 / LARGEST_GROWTH)
    kept &= aside < LARGEST_SIDESTEP * (rise + start[:, 2] / 2)
    start, end, rise = start[kept], end[kept], rise[kept]
    middle, size = (start[:, 1] + end[:, 1]) / 2, (start[:, 2] + end[:, 2]) / 2
    return np.column_stack(
        [np.full(len(rise), frame), middle, start[:, 1], end[:, 1], size, rise / interval_s]
    )


def by_height(
    table: pd.DataFrame, risen: pd.DataFrame, edges_m: NDArray[np.float64], duration_s: float
) -> pd.DataFrame:
    """Means over bubbles by height.

    Parameters
    ----------
    table, risen : DataFrame
        Of `bubble_table` and `rises`.
    edges_m : (n_rows + 1,) array
        Of the rows [m].
    duration_s : float
        Time that was looked at [s].

    Returns
    -------
    DataFrame
        height_m, bubbles_1, diameter_m, velocity_m_s, and frequency_Hz: bubbles seen to pass the middle of a
        row; NaN in rows with fewer than five bubbles.
    """
    middles = (edges_m[1:] + edges_m[:-1]) / 2
    passed = (risen["from_m"].to_numpy() < middles[:, None]) & (risen["to_m"].to_numpy() >= middles[:, None])
    means = {
        name: data.groupby(pd.cut(data["z_m"], edges_m), observed=False)[name].agg(["mean", "count"])
        for data, name in ((table, "diameter_m"), (risen, "velocity_m_s"))
    }
    rows = {"height_m": middles, "bubbles_1": means["diameter_m"]["count"].to_numpy()}
    for name, values in means.items():
        rows[name] = values["mean"].where(values["count"] >= SMALLEST_SAMPLE).to_numpy()
    return pd.DataFrame(rows | {"frequency_Hz": passed.sum(axis=1) / duration_s})


def middle_of_bed(table: pd.DataFrame, risen: pd.DataFrame, height_m: float) -> dict[str, float]:
    """Mean diameter and rise velocity of bubbles between 0.4 and 0.6 of a bed's height; NaN without any."""
    return {
        name: float(data.loc[data["z_m"].between(0.4 * height_m, 0.6 * height_m), column].mean())
        for name, data, column in (
            ("bubble_diameter_m", table, "diameter_m"),
            ("bubble_velocity_m_s", risen, "velocity_m_s"),
        )
    }
