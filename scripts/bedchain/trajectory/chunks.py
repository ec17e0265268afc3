# SPDX-License-Identifier: GPL-3.0-or-later
"""Chunks of frames: the memory in use does not grow with the length of a trajectory."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.grid import OUTSIDE

# copied out of the memory map, whose pages can then be freed
CHUNK_BYTES = 64 * 2**20


def chunks(
    cells: NDArray[np.int32],
    n_cells: int,
    starts: NDArray[np.int64],
    weights: NDArray[np.int64],
    shifts: Sequence[int],
) -> Iterator[tuple[list[NDArray[np.int32]], NDArray[np.int64]]]:
    """Cells at the starts of steps and some frames later, in chunks of steps.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle.
    n_cells : int
        Number of cells of the grid.
    starts : (n_starts,) int64 array
        Frames at which steps start, ascending.
    weights : (n_starts,) int64 array
        Number of times that each start counts [1].
    shifts : sequence of int
        Frames after the start to give, such as 0 and the lag.

    Yields
    ------
    parts : list of (n, n_particles) arrays
        Cells after n starts, an array for each shift; `grid.OUTSIDE` for particles that are not there.
    weights : (n,) int64 array
        Weights of these starts.

    Raises
    ------
    DataError
        A cell number is outside the grid.
    """
    frame_bytes = max(cells.shape[1] * cells.dtype.itemsize, 1)
    span = max(CHUNK_BYTES // frame_bytes // len(shifts), 1)
    begin = 0
    while begin < starts.size:
        end = int(np.searchsorted(starts, starts[begin] + span))
        at = starts[begin:end]
        parts = []
        for shift in shifts:
            low = int(at[0]) + shift
            frames = read_frames(cells, low, int(at[-1]) + shift + 1)
            _check_cells(frames, n_cells, low)
            parts.append(frames if len(frames) == at.size else frames[at - at[0]])
        yield parts, weights[begin:end]
        begin = end


def read_frames(array: NDArray[np.int32], low: int, high: int) -> NDArray[np.int32]:
    """Frames ``low`` to ``high``; of a memory map a copy, through a second map that is then closed.

    The pages of a map stay in the memory of the process until it is closed.
    """
    if not isinstance(array, np.memmap) or array.filename is None or not array.flags.c_contiguous:
        return array[low:high]
    frame_bytes = array.strides[0]
    offset = array.offset + _distance(array) + low * frame_bytes
    shape = (high - low, *array.shape[1:])
    return np.array(np.memmap(array.filename, array.dtype, "r", offset, shape))


def _distance(array: np.memmap) -> int:
    """Bytes from the start of the map to the start of a view of it."""
    base = array
    while isinstance(base.base, np.memmap):
        base = base.base
    return int(array.ctypes.data - base.ctypes.data)


def _check_cells(frames: NDArray[np.int32], n_cells: int, first_frame: int) -> None:
    if frames.size and (frames.min() < OUTSIDE or frames.max() >= n_cells):
        frame, particle = (int(i) for i in np.argwhere((frames < OUTSIDE) | (frames >= n_cells))[0])
        raise DataError(
            f"particle {particle} (counted from 0) in frame {first_frame + frame} is in cell "
            f"{frames[frame, particle]}, the grid has cells 0 to {n_cells - 1}: assign the cells again"
        )
