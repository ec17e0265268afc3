# SPDX-License-Identifier: GPL-3.0-or-later
"""Compressed positions of many particles over many frames, rounded to levels of a fraction of a millimetre.

Velocities change little between frames, so the second differences of the levels over time are small. In each
frame their low bytes stand before the high bytes, which are nearly all zero; xz then needs about one byte for
both coordinates of a particle.
"""

import lzma
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.files import atomic_file

# no context between bytes: neighbours in the file are unrelated particles
FILTERS = [{"id": lzma.FILTER_LZMA2, "preset": 6, "lc": 0, "lp": 0, "pb": 0}]
PART_BYTES = 1 << 20
Levels = NDArray[np.uint16]


def levels_of(positions_m: NDArray[np.floating], level_m: float) -> Levels:
    """Positions rounded down to whole levels.

    Parameters
    ----------
    positions_m : (...) array
        At least 0 [m].
    level_m : float
        Height of a level [m].

    Returns
    -------
    (...) uint16 array

    Raises
    ------
    UserError
        A position is below 0 or above 65 535 levels.
    """
    levels = np.floor(np.asarray(positions_m, np.float64) / level_m)
    if levels.min() < 0 or levels.max() > np.iinfo(np.uint16).max:
        raise UserError(
            f"positions from {positions_m.min():g} m to {positions_m.max():g} m do not fit into 65 536 "
            f"levels of {level_m:g} m: take larger ones"
        )
    return levels.astype(np.uint16)


def middle_of(levels: Levels, level_m: float) -> NDArray[np.float32]:
    """Middle of the levels [m], never on a line between two levels."""
    return ((levels + 0.5) * level_m).astype(np.float32)


def write_levels(frames: Iterable[Levels], target: Path) -> None:
    """Write compressed frames.

    Parameters
    ----------
    frames : iterable of (2, n_particles) uint16 array
        Levels of x and z.
    target : Path
        File to write.
    """
    before: Levels | np.uint16 = np.uint16(0)
    last: Levels | np.uint16 = np.uint16(0)
    with atomic_file(target) as temporary, lzma.open(temporary, "wb", filters=FILTERS) as stream:
        for at, levels in enumerate(frames):
            # uint16 wraps around, as in read_levels
            change = (levels - last - (last - before if at > 1 else np.uint16(0))).view(np.int16)
            folded = ((change << 1) ^ (change >> 15)).view(np.uint16)
            for byte in (folded & 0xFF, folded >> 8):
                stream.write(byte.astype(np.uint8).tobytes())
            before, last = last, levels


def read_levels(source: Path, n_frames: int, number: int) -> Iterator[Levels]:
    """Frames of `write_levels`.

    Parameters
    ----------
    source : Path
    n_frames, number : int
        Frames, and particles in a frame [1].

    Yields
    ------
    (2, number) uint16 array

    Raises
    ------
    UserError
        The file is missing or damaged, or holds fewer or more frames.
    """
    before: Levels | np.uint16 = np.uint16(0)
    last: Levels | np.uint16 = np.uint16(0)
    with _unpacked(source) as stream:
        for at in range(n_frames):
            data = _take(stream, 4 * number)
            if data is None or len(data) < 4 * number:
                raise UserError(f"{source} ends at frame {at} of {n_frames}: fetch it again")
            low, high = np.frombuffer(data, np.uint8).reshape(2, 2, number).astype(np.uint16)
            folded = low | (high << 8)
            change = (folded >> 1) ^ (0 - (folded & 1)).astype(np.uint16)
            levels = change + last + (last - before if at > 1 else np.uint16(0))
            before, last = last, levels
            yield levels
        rest = _take(stream, 1)
        if rest is None:
            raise UserError(f"{source} is damaged behind its last frame: fetch it again")
        if rest:
            raise UserError(f"{source} holds more than {n_frames} frames of {number}: fetch it again")


def _unpacked(source: Path) -> IO[bytes]:
    try:
        return lzma.open(source, "rb")
    except OSError as error:
        raise UserError(f"{source} cannot be read ({error.strerror}): fetch it again") from error


def _take(stream: IO[bytes], size: int) -> bytes | None:
    """So many bytes, fewer at the end, None at damage; in parts, so that a wrong size takes no memory."""
    parts = []
    try:
        while size > 0 and (part := stream.read(min(size, PART_BYTES))):
            parts.append(part)
            size -= len(part)
    except (EOFError, lzma.LZMAError, MemoryError):  # of a header that asks for gigabytes
        return None
    return b"".join(parts)


def with_velocities(
    frames: Iterable[Levels], level_m: float, interval_s: float
) -> Iterator[NDArray[np.float32]]:
    """Frames in the form of the trajectory: positions, and velocities from the frames before and after.

    Parameters
    ----------
    frames : iterable of (2, n_particles) uint16 array
        At least two.
    level_m : float
        Height of a level [m].
    interval_s : float
        Time between frames [s].

    Yields
    ------
    (4, n_particles) float32 array
        x, z [m], vx, vz [m/s]; velocities by central differences, at the ends by one-sided ones.
    """
    before: NDArray[np.float32] | None = None
    now: NDArray[np.float32] | None = None
    for levels in frames:
        after = middle_of(levels, level_m)
        if now is not None:
            yield _moving(now, now if before is None else before, after, interval_s)
        before, now = now, after
    assert before is not None and now is not None
    yield _moving(now, before, now, interval_s)


def _moving(
    now: NDArray[np.float32], before: NDArray[np.float32], after: NDArray[np.float32], interval_s: float
) -> NDArray[np.float32]:
    steps = (before is not now) + (after is not now)
    return np.concatenate([now, (after - before) / np.float32(steps * interval_s)])
