# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells of all particles in all frames on disk, written and read in chunks of frames."""

import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.array_files import map_array, read_arrays
from bedchain.errors import DataError, UserError, make_again
from bedchain.files import atomic_file, write_npy_header
from bedchain.trajectory.chunks import read_frames
from bedchain.trajectory.grid import OUTSIDE, Grid

# positions of a chunk: about 16 MB with the velocities
CHUNK_VALUES = 1_000_000


class CellStore(NamedTuple):
    """Cells of all particles in all frames.

    Attributes
    ----------
    cells : (n_frames, n_particles) ndarray of int32
        Memory map: only the frames in use are read. `grid.OUTSIDE` for a particle that is not there.
    times_s : (n_frames,) ndarray
        Times of the frames [s].
    grid : Grid
    """

    cells: np.ndarray
    times_s: np.ndarray
    grid: Grid


def write_cells(
    trajectory: np.ndarray, times_s: np.ndarray, grid: Grid, target: Path, outside: str = "refuse",
    y_row: int | None = None, complete: bool = True,
) -> int:  # fmt: skip
    """Write the cell of every particle in every frame, in chunks of frames.

    Parameters
    ----------
    trajectory : (n_frames, 4, n_particles) ndarray
        Rows x, z [m], ...
    times_s : (n_frames,) ndarray
        Times of the frames [s].
    grid : Grid
    target : Path
        ``cells.npz``: cells, times_s, and the arrays of the grid.
    outside : {"refuse", "exit"}
        Whether a particle may leave the bed; it is then `grid.OUTSIDE`.
    y_row : int, optional
        Row of the positions along y [m], where there is one.
    complete : bool
        Whether all particles are in all frames; if not, those that are not there have `grid.OUTSIDE`.

    Returns
    -------
    int
        Particles outside, summed over the frames.

    Raises
    ------
    DataError
        A position is outside a bed that no particle may leave.
    """
    n_frames, _, n_particles = trajectory.shape
    chunk = max(1, CHUNK_VALUES // n_particles)
    may_leave, gone = outside == "exit", 0
    with atomic_file(target) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        # the file of numpy.savez, without the whole array in memory
        with archive.open("cells.npy", "w", force_zip64=True) as stream:
            write_npy_header(stream, (n_frames, n_particles), np.dtype(np.int32))
            for first in range(0, n_frames, chunk):
                part = read_frames(trajectory, first, min(first + chunk, n_frames))
                y = None if y_row is None else part[:, y_row]
                if complete and not may_leave:
                    cells = grid.cell_of(part[:, 0], part[:, 1], first, y)
                else:
                    cells = grid.cells_seen(part[:, 0], part[:, 1], first, y, may_leave)
                    gone += int((cells == OUTSIDE).sum())
                stream.write(cells.tobytes())
        for name, value in {"times_s": times_s, **grid.arrays()}.items():
            with archive.open(f"{name}.npy", "w") as stream:
                np.lib.format.write_array(stream, np.asarray(value))
    return gone


def open_cells(path: Path) -> CellStore:
    """Cells of `write_cells` as a memory map.

    Parameters
    ----------
    path : Path
        ``cells.npz``.

    Returns
    -------
    CellStore

    Raises
    ------
    UserError
        The file was not written by `write_cells`.
    """
    try:
        cells = map_array(path, "cells")
        small = read_arrays(path, but="cells")
        times_s = np.asarray(small["times_s"], float)
        grid = Grid.from_arrays(small)
        if times_s.shape != cells.shape[:1] or cells.ndim != 2 or cells.dtype.kind != "i":
            raise DataError(f"{cells.dtype} of the shape {cells.shape} for {times_s.size} times")
    except (DataError, ValueError, TypeError, KeyError, OverflowError) as error:
        raise UserError(f"{path}: not readable as cells ({error}); {make_again(path)}") from error
    return CellStore(cells, times_s, grid)


def frame_at(times_s: np.ndarray, time_s: float) -> int:
    """Number of the frame nearest to a time.

    Parameters
    ----------
    times_s : (n_frames,) ndarray
        Times of the frames [s].
    time_s : float
        Wanted time [s].

    Returns
    -------
    int

    Raises
    ------
    UserError
        No frame within half an interval.
    """
    index = int(np.argmin(np.abs(times_s - time_s)))
    interval = (times_s[-1] - times_s[0]) / max(len(times_s) - 1, 1)
    if abs(times_s[index] - time_s) > 0.5 * interval:
        raise UserError(f"no frame at {time_s:g} s: frames go from {times_s[0]:g} s to {times_s[-1]:g} s")
    return index
