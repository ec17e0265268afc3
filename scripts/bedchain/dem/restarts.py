# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether what the solvers wrote at the end of a segment is complete: they end with 0 on a disk that is full.

LIGGGHTS' restart (write_restart.cpp): a header of less than 64 kB, then for each MPI rank an i32 count and
that many f64; in there, particle after particle, each begins with the number of its values. No end mark: it
is complete where a place after the header leads, chunk by chunk, exactly to the end of the file.
"""

import shutil
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
from tqdm import tqdm

from bedchain.dem.gas_case import last_time
from bedchain.errors import DataError, UserError

LONGEST_HEADER = 1 << 16
COUNT_BYTES, VALUE_BYTES = 4, 8
GAS_FIELDS = ("U", "gradP", "p", "phi", "voidage", "uniform/time")  # all that a segment goes on from
END_MARK = b"// **"  # of the last line of a file that OpenFOAM has written
END_BYTES = 100
SAME_TIME = 1e-6  # of a segment's end and the name of its last time folder [s]


@contextmanager
def complete(part: Path) -> Iterator[None]:
    """Checks of what a solver left when it ended with 0: an error says that this is not complete, and why.

    Raises
    ------
    UserError
        With the free space of the disk, which may have been full for a moment.
    """
    try:
        yield
    except UserError as error:
        free = tqdm.format_sizeof(shutil.disk_usage(part).free, "B")
        raise UserError(
            f"{part.stem} is not complete though its solver ended well: {error}\n{free} are free on the disk "
            "now: it may have been full for a moment. Free some space and give the same command again: "
            "it goes on from the last good state"
        ) from error


def check_restart(file: Path, number: int) -> None:
    """Refuse a restart of LIGGGHTS that is cut off, or that holds another number of particles.

    Parameters
    ----------
    file : Path
        ``particles.restart``.
    number : int
        Particles of the bed.

    Raises
    ------
    DataError
        Names the file and what is wrong.
    """
    try:
        content = file.read_bytes()
    except OSError as error:
        raise DataError(f"{file} cannot be read ({error.strerror})") from error
    for start in range(min(LONGEST_HEADER, len(content))):
        chunks = _chunks(content, start)
        if chunks is not None and _particles(content, chunks) == number:
            return
    raise DataError(f"{file} is no whole restart of {number} particles: it was cut off or changed")


def _chunks(content: bytes, start: int) -> list[tuple[int, int]] | None:
    """Place and count of the values of each rank, if they fill the file from a place to its end."""
    chunks = []
    while start < len(content):
        if start + COUNT_BYTES > len(content):
            return None
        (count,) = struct.unpack_from("<i", content, start)
        start += COUNT_BYTES
        if count < 0 or start + count * VALUE_BYTES > len(content):
            return None
        chunks.append((start, count))
        start += count * VALUE_BYTES
    return chunks


def _particles(content: bytes, chunks: list[tuple[int, int]]) -> int:
    """Particles in the chunks; -1 where their lengths do not add up."""
    number = 0
    for start, count in chunks:
        values = np.frombuffer(content, "<f8", count, start)
        place = 0
        while place < count:
            length = values[place]
            if not 1 <= length <= count - place or length % 1:
                return -1
            place += int(length)
            number += 1
    return number


def check_gas(gas: Path, ranks: int, end_s: float) -> None:
    """Refuse the OpenFOAM case of a segment whose last fields are not those of its end, or are cut off.

    Parameters
    ----------
    gas : Path
        Folder ``gas`` of the segment.
    ranks : int
        MPI ranks that wrote it.
    end_s : float
        End of the segment [s].

    Raises
    ------
    DataError
        Names the file and what is wrong.
    """
    parts = [gas / f"processor{rank}" for rank in range(ranks)] if ranks > 1 else [gas]
    for part in parts:
        last = last_time(part) if part.is_dir() else None
        if last is None or abs(float(last.name) - end_s) > SAME_TIME:
            raise DataError(f"{part} has no fields of {end_s:g} s")
        mesh = part / "constant" / "polyMesh"
        for file in [*(last / name for name in GAS_FIELDS), *sorted(mesh.iterdir())]:
            _check_end_mark(file)


def _check_end_mark(file: Path) -> None:
    try:
        whole = END_MARK in file.read_bytes()[-END_BYTES:]
    except OSError as error:
        raise DataError(f"{file} cannot be read ({error.strerror})") from error
    if not whole:
        raise DataError(f"{file} is cut off: OpenFOAM's last line is not in it")


def check_series(file: Path, span_s: tuple[float, float], row_s: float) -> None:
    """Refuse the time series of a segment that does not reach from its start to its end.

    Parameters
    ----------
    file : Path
        ``bed_series.csv`` of the segment.
    span_s : (float, float)
        Start and end of the segment [s].
    row_s : float
        Time between two rows [s].

    Raises
    ------
    DataError
        Names the file and what is wrong.
    """
    try:
        ended = file.read_bytes().endswith(b"\n")
        table = pd.read_csv(file)
        times = table["time_s"].to_numpy(float)
    except (OSError, ValueError, KeyError) as error:
        raise DataError(f"{file} cannot be read ({error})") from error
    ends = (span_s[0], *times, span_s[1])
    if not ended or table.isna().any(axis=None) or np.diff(ends).max() > 1.5 * row_s:
        span = f"{span_s[0]:g} to {span_s[1]:g} s"
        raise DataError(f"{file} is cut off or has a gap: rows from {span} expected")
