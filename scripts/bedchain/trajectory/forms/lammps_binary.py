# SPDX-License-Identifier: GPL-3.0-or-later
"""Native binary dumps of LIGGGHTS and LAMMPS, one frame a file or many in one.

LIGGGHTS and older LAMMPS: i64 step, i64 particles, i32 triclinic, 6 i32 boundary flags, 6 f64 box, i32
columns, i32 chunks; then per chunk an i32 count of doubles and that many f64; no names of columns. Newer
LAMMPS starts with a negative i64, whose size is the length of a magic word; then the word, i32 byte order,
i32 revision and the header as before, with units, time and names of columns before the chunks (LAMMPS,
tools/binary2txt.cpp).
"""

import struct
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from bedchain.errors import DataError
from bedchain.trajectory.forms.lammps_text import MOST_PARTICLES, TRICLINIC
from bedchain.trajectory.forms.raw import PARTICLE, Columns, CutOffError, RawFrame, our_columns, unscaled
from bedchain.trajectory.forms.streams import Source

MAGIC_WORDS = (b"DUMPATOM", b"DUMPCUSTOM")
MOST_COLUMNS, MOST_CHUNKS, MOST_WORD_BYTES = 1000, 1_000_000, 65_536
SAME_ORDER = 1
NO_NAMES = (
    "a binary dump holds {columns} columns without their names: name them in frames.names, as in the dump "
    "command, such as [id, x, z, vx, vz]"
)


def read_frames(
    source: Source, renamed: Mapping[str, str], names: Sequence[str] | None = None
) -> Iterator[RawFrame]:
    """Frames of a binary dump, in the order of the file.

    Parameters
    ----------
    source : Source
    renamed : mapping of str to str
        Our name -> name in the file.
    names : sequence of str, optional
        Of the columns, where the file has none.

    Yields
    ------
    RawFrame

    Raises
    ------
    DataError
        The header makes no sense, the box is triclinic, or columns have no names.
    CutOffError
        The file ends inside a frame.
    """
    while not source.at_end():
        header = _header(source, names)
        chunks = _chunks(source, header)
        places = our_columns(header["names"], renamed)
        columns = tuple(name for name in PARTICLE if name in places)
        load = partial(_values, chunks, header, {name: places[name] for name in columns})
        yield RawFrame(
            columns, load, header["step"], header["time"], header["number"], header["box"], header["periodic"]
        )


def _take(source: Source, form: str) -> tuple[Any, ...]:
    size = struct.calcsize("<" + form)
    content = source.exactly(size)
    if len(content) < size:
        raise CutOffError("the last frame is cut off in its header")
    return struct.unpack("<" + form, content)


def _word(source: Source) -> str:
    (length,) = _take(source, "i")
    if not 0 <= length <= MOST_WORD_BYTES:
        raise DataError(f"its header has a text of {length} bytes: this is no binary dump")
    return b"".join(_take(source, f"{length}s")).decode("ascii", "replace")


def _header(source: Source, names: Sequence[str] | None) -> dict[str, Any]:
    (step,) = _take(source, "q")
    revision, time = 0, None
    if step < 0:
        if -step > max(map(len, MAGIC_WORDS)) or _take(source, f"{-step}s")[0] not in MAGIC_WORDS:
            raise DataError(f"its first number, {step}, is no step: this is no binary dump")
        order, revision, step = _take(source, "iiq")
        if order != SAME_ORDER:
            raise DataError(
                "it was written on a machine with another order of bytes: convert it with binary2txt"
            )
    number, triclinic = _take(source, "qi")
    flags, box = _take(source, "6i"), np.array(_take(source, "6d")).reshape(3, 2)
    if triclinic == 1:
        raise DataError(TRICLINIC)
    (columns,) = _take(source, "i")
    if not (0 <= number <= MOST_PARTICLES and 0 < columns <= MOST_COLUMNS and triclinic == 0 and step >= 0):
        raise DataError(
            f"its header tells of {number} particles with {columns} columns: this is no binary dump"
        )
    if not np.isfinite(box).all():
        raise DataError("the bounds of its box are no numbers: this is no binary dump")
    if revision > 1:
        _word(source)
        if _take(source, "?")[0]:
            (time,) = _take(source, "d")
        names = _word(source).split()
    if names is None or len(names) != columns:
        given = "" if names is None else f"; frames.names has {len(names)}"
        raise DataError(NO_NAMES.format(columns=columns) + given)
    (chunks,) = _take(source, "i")
    if not 0 < chunks <= MOST_CHUNKS:
        raise DataError(f"its header tells of {chunks} chunks: this is no binary dump")
    return {
        "step": step, "time": time, "number": number, "box": box, "columns": columns, "names": names,
        "chunks": chunks, "periodic": tuple(flags[2 * axis] == 0 for axis in range(3)),
    }  # fmt: skip


def _chunks(source: Source, header: dict[str, Any]) -> list[bytes]:
    """Values that each rank wrote."""
    chunks, values = [], 0
    for chunk in range(header["chunks"]):
        (count,) = _take(source, "i")
        if count < 0 or count % header["columns"]:
            raise DataError(f"chunk {chunk + 1} has {count} values, not whole rows of {header['columns']}")
        content = source.exactly(8 * count)
        values += len(content) // 8
        if len(content) < 8 * count:
            there = values // header["columns"]
            raise CutOffError(
                f"the frame of step {header['step']} is cut off: {there} of {header['number']} particles"
            )
        chunks.append(content)
    if values != header["number"] * header["columns"]:
        there = values // header["columns"]
        raise DataError(
            f"the frame of step {header['step']} holds {there} particles, {header['number']} announced"
        )
    return chunks


def _values(chunks: list[bytes], header: dict[str, Any], places: dict[str, int]) -> Columns:
    rows = np.concatenate([np.frombuffer(chunk, "<f8") for chunk in chunks]).reshape(-1, header["columns"])
    values = {name: rows[:, at] for name, at in places.items()}
    return unscaled(values, header["names"], header["box"])
