# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of particles from LIGGGHTS dumps, native binary or text, with checks.

The binary form (``dump ... custom ... *.bin``) is a header and, for each MPI rank, a count and the values:
i64 step, i64 particles, i32 triclinic, 6 i32 boundary flags, 6 f64 box, i32 columns, i32 chunks; then per
chunk an i32 count of doubles and that many f64. The names of the columns come from the run's manifest.
"""

from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.errors import UserError

HEADER = np.dtype(
    [
        ("step", "<i8"),
        ("number", "<i8"),
        ("triclinic", "<i4"),
        ("boundary", "<i4", 6),
        ("box", "<f8", 6),
        ("columns", "<i4"),
        ("chunks", "<i4"),
    ]
)
COUNT_BYTES = 4
VALUE_BYTES = 8
TEXT_ITEMS = ("ITEM: TIMESTEP", "ITEM: NUMBER OF ATOMS", "ITEM: BOX BOUNDS", "ITEM: ATOMS")
TEXT_HEADER_LINES = 9
IDS_SHOWN = 5
MOST_COLUMNS = 1000


class Dump(NamedTuple):
    """A frame as in the file, in the file's order of particles.

    Attributes
    ----------
    step : int
        DEM step of the frame [1].
    box : (3, 2) ndarray
        Lower and upper bound of the box in x, y and z [m].
    values : (n_particles, n_columns) ndarray
        A row for each particle, in the columns of the dump command, SI units.
    """

    step: int
    box: np.ndarray
    values: np.ndarray


def read_dump(path: Path, columns: list[str]) -> Dump:
    """Dump from a file of either form; the first bytes decide which.

    Parameters
    ----------
    path : Path
        A file of a single frame, written by LIGGGHTS ``dump custom``.
    columns : list of str
        Expected columns, in order.

    Returns
    -------
    Dump

    Raises
    ------
    UserError
        The file is missing, cut off, or holds other columns.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror})") from error
    if content.startswith(b"ITEM:"):
        return _parse_text(content, path, columns)
    return _parse_binary(content, path, columns)


def _parse_binary(content: bytes, path: Path, columns: list[str]) -> Dump:
    if len(content) < HEADER.itemsize:
        raise UserError(f"{path} is cut off: {len(content)} bytes, its header alone takes {HEADER.itemsize}")
    header = np.frombuffer(content, HEADER, count=1)[0]
    plausible = 0 < header["columns"] < MOST_COLUMNS and header["number"] >= 0 and header["chunks"] > 0
    if header["triclinic"] or not plausible:
        raise UserError(f"{path} is no LIGGGHTS dump of an orthogonal box: its header makes no sense")
    if header["columns"] != len(columns):
        expected = f"{len(columns)} expected ({' '.join(columns)})"
        raise UserError(f"{path} has {header['columns']} columns, {expected}")
    chunks = _binary_chunks(content, path, int(header["chunks"]), len(columns))
    values = np.concatenate(chunks).reshape(-1, len(columns))
    if len(values) != header["number"]:
        raise UserError(f"{path} holds {len(values)} particles, its header announces {header['number']}")
    return Dump(int(header["step"]), header["box"].reshape(3, 2).copy(), values)


def _binary_chunks(content: bytes, path: Path, n_chunks: int, n_columns: int) -> list[np.ndarray]:
    """Views on the values that each MPI rank wrote."""
    chunks = []
    offset = HEADER.itemsize
    for chunk in range(n_chunks):
        left = len(content) - offset - COUNT_BYTES
        count = int(np.frombuffer(content, "<i4", 1, offset)[0]) if left >= 0 else 0
        if left < 0 or count * VALUE_BYTES > left:
            raise UserError(
                f"{path} is cut off in chunk {chunk + 1} of {n_chunks}: "
                f"{max(left, 0) // (VALUE_BYTES * n_columns)} of {count // n_columns} particles are there"
            )
        if count < 0 or count % n_columns:
            raise UserError(f"{path}: chunk {chunk + 1} has {count} values, not whole rows of {n_columns}")
        chunks.append(np.frombuffer(content, "<f8", count, offset + COUNT_BYTES))
        offset += COUNT_BYTES + count * VALUE_BYTES
    if offset != len(content):
        raise UserError(f"{path} has {len(content) - offset} bytes after its last particle")
    return chunks


def _parse_text(content: bytes, path: Path, columns: list[str]) -> Dump:
    lines = content.split(b"\n", TEXT_HEADER_LINES)
    if len(lines) <= TEXT_HEADER_LINES:
        raise UserError(f"{path} is cut off in its header")
    header = [line.decode("ascii", "replace").strip() for line in lines[:TEXT_HEADER_LINES]]
    if not all(header[at].startswith(item) for at, item in zip((0, 2, 4, 8), TEXT_ITEMS, strict=True)):
        raise UserError(f"{path} is no LIGGGHTS text dump of one frame: its ITEM lines are not in place")
    if header[8].split()[2:] != columns:
        raise UserError(f"{path} has the columns {header[8][12:]}, expected {' '.join(columns)}")
    body = lines[TEXT_HEADER_LINES]
    try:
        step, number, rows = int(header[1]), int(header[3]), body.count(b"\n")
        # a last line without its end may have lost digits
        if rows != number or not content.endswith(b"\n"):
            raise UserError(f"{path} is cut off: {rows} of {number} particles are there")
        values = np.loadtxt(BytesIO(body), comments=None, ndmin=2).reshape(number, len(columns))
        return Dump(step, np.loadtxt(header[5:8]), values)
    except ValueError as error:
        raise UserError(f"{path} is no table of numbers ({error})") from error


def frame_of(dump: Dump, columns: list[str], ids: np.ndarray | None, bounds: dict[str, float]) -> np.ndarray:
    """Columns of a dump with particles sorted by id, after all checks of a single frame.

    Parameters
    ----------
    dump : Dump
    columns : list of str
        Names of the dump's columns, ``id`` among them.
    ids : (n_particles,) ndarray of int64 or None
        Expected ids, ascending; None accepts any set without doubles.
    bounds : dict of str to float
        Upper bound of a position column, the lower bound being 0, e.g. ``{"x": 0.27, "z": 1.05}`` [m].

    Returns
    -------
    (n_columns, n_particles) ndarray
        Rows in the order of ``columns``.

    Raises
    ------
    UserError
        A value is not finite, an id is missing, doubled or unknown, or a particle is outside the bed.
    """
    values = dump.values.T
    dump_ids = values[columns.index("id")]
    if not np.isfinite(values).all():
        column, particle = np.argwhere(~np.isfinite(values))[0]
        name, value = columns[column], values[column, particle]
        raise UserError(f"{name} of particle {dump_ids[particle]:.0f} is {value}")
    order = np.argsort(dump_ids, kind="stable")
    frame = values[:, order]
    _check_ids(frame[columns.index("id")], ids)
    for name, upper in bounds.items():
        _check_bounds(frame[columns.index(name)], frame[columns.index("id")], name, upper)
    return frame


def _check_ids(ids: np.ndarray, expected: np.ndarray | None) -> None:
    """Refuse doubled ids among ascending ones and, where ``expected`` is given, missing and unknown ones."""
    if expected is not None and np.array_equal(ids, expected):
        return
    problems = [("doubled", ids[1:][np.diff(ids) == 0]), ("not a whole number", ids[ids % 1 != 0])]
    if expected is not None:
        problems += [("missing", np.setdiff1d(expected, ids)), ("unknown", np.setdiff1d(ids, expected))]
    text = "; ".join(f"{problem}: id {listed(wrong)}" for problem, wrong in problems if wrong.size)
    if text:
        raise UserError(text)


def _check_bounds(position: np.ndarray, ids: np.ndarray, name: str, upper: float) -> None:
    # in single precision, as stored: 0.09 becomes 0.0900000036 on both sides
    with np.errstate(over="ignore"):  # infinite is outside too
        single = position.astype(np.float32)
    outside = (single < 0) | (single > np.float32(upper))
    if outside.any():
        worst = position[outside][np.argmax(np.abs(position[outside] - upper / 2))]
        beyond = max(worst - upper, -worst)
        raise UserError(
            f"{outside.sum()} particles are outside the bed, 0 to {upper:g} m in {name} "
            f"(id {listed(ids[outside])}; the farthest by {beyond:.3g} m)"
        )


def listed(ids: np.ndarray) -> str:
    """The first few ids, and the number of the others, as text."""
    text = ", ".join(f"{number:.10g}" for number in ids[:IDS_SHOWN].tolist())
    return text + (f" and {ids.size - IDS_SHOWN} more" if ids.size > IDS_SHOWN else "")
