# SPDX-License-Identifier: GPL-3.0-or-later
"""Legacy VTK up to version 4.2 (LIGGGHTS's), ascii or binary: points, vertices, and arrays of the points.

VTK's reader believes the numbers of a damaged header, and can go on for minutes over a few bytes; this one
takes what is there (VTK User's Guide, "VTK File Formats", simple legacy formats).
"""

import re
import warnings
from typing import NamedTuple

import numpy as np

from bedchain.errors import DataError

START = re.compile(rb"# vtk DataFile Version [1-4]\.\d+ *\r?\n.*\n(ASCII|BINARY) *\r?\n")
TYPES = {
    b"char": ">i1", b"unsigned_char": ">u1", b"short": ">i2", b"unsigned_short": ">u2", b"int": ">i4",
    b"unsigned_int": ">u4", b"long": ">i8", b"unsigned_long": ">u8", b"float": ">f4", b"double": ">f8",
    b"vtkIdType": ">i4",
}  # fmt: skip
NEXT_WORD = re.compile(rb"\n[ \t]*(?!nan|inf)[A-Za-z_]")
WIDEST = 9  # values of a particle in an array: a tensor


class Values(NamedTuple):
    """Points (n_points, 3), and the arrays of their field (n_points, n_components) by name."""

    points: np.ndarray
    fields: dict[str, np.ndarray]


def is_early(content: bytes) -> bool:
    """Whether a file is legacy VTK, and not of version 5, whose cells have another form."""
    return content.startswith(b"# vtk DataFile") and not content.startswith(b"# vtk DataFile Version 5")


def read_values(content: bytes) -> Values:
    """Points and fields of a file's content.

    Raises
    ------
    DataError
        It is cut off or damaged; the part is named.
    """
    start = START.match(content)
    if start is None:
        raise DataError("the first lines of this VTK file are damaged")
    reader = _Reader(content, start.end(), start[1] == b"BINARY")
    points: np.ndarray | None = None
    fields: dict[str, np.ndarray] = {}
    waiting: list[bytes] = []
    while (words := reader.words()) is not None:
        if words[:1] == [b"DATASET"]:
            continue
        if words[0] == b"POINTS" and len(words) == 3:
            points = reader.array(words[1], 3, words[2])
        elif words[0] == b"VERTICES" and len(words) == 3:
            _count(words[1], len(content))
            reader.array(words[2], 1, b"int")
        elif words[0] in (b"POINT_DATA", b"FIELD", b"LOOKUP_TABLE", b"SCALARS", b"VECTORS"):
            if words[0] in (b"SCALARS", b"VECTORS"):
                waiting = words
            if waiting and words[0] in (b"LOOKUP_TABLE", b"VECTORS") and points is not None:
                columns = 3 if waiting[0] == b"VECTORS" else _count((*waiting, b"1")[3], WIDEST)
                number = str(len(points)).encode()
                fields[_name(waiting)] = reader.array(number, columns, (*waiting, b"", b"")[2])
                waiting = []
        elif len(words) == 4 and words[3] in TYPES:
            fields[words[0].decode("latin-1")] = reader.array(words[2], _count(words[1], WIDEST), words[3])
        else:
            raise DataError(f"{b' '.join(words)[:60].decode('latin-1')!r} is no part of a file of particles")
    if points is None:
        raise DataError("a VTK file without points: it is cut off")
    for name, array in fields.items():
        if len(array) != len(points):
            raise DataError(f"{name} has {len(array)} values for {len(points)} points")
    return Values(points, fields)


def _name(words: list[bytes]) -> str:
    return words[1].decode("latin-1") if len(words) > 1 else ""


def _count(word: bytes, most: int) -> int:
    if not word.isdigit() or len(word) > 18 or int(word) > most:
        raise DataError(
            f"the header announces {word[:30].decode('latin-1')} values, at most {most} can be there"
        )
    return int(word)


class _Reader:
    """A place in a content that moves on."""

    def __init__(self, content: bytes, at: int, binary: bool) -> None:
        self.content, self.at, self.binary = content, at, binary

    def words(self) -> list[bytes] | None:
        """Words of the next line that has any; None at the end."""
        while self.at < len(self.content):
            end = self.content.find(b"\n", self.at)
            end = len(self.content) if end < 0 else end
            words = self.content[self.at : end].split()
            self.at = end + 1
            if words:
                return words
        return None

    def array(self, rows: bytes, columns: int, kind: bytes) -> np.ndarray:
        """The next values, (rows, columns)."""
        if kind not in TYPES:
            raise DataError(f"values of the type {kind[:30].decode('latin-1')!r}, which VTK does not have")
        number = _count(rows, len(self.content)) * columns
        values = self._binary(number, TYPES[kind]) if self.binary else self._ascii(number)
        return values.reshape(-1, columns) if number else np.empty((0, columns))

    def _binary(self, number: int, kind: str) -> np.ndarray:
        dtype = np.dtype(kind)
        if len(self.content) - self.at < number * dtype.itemsize:
            there = (len(self.content) - self.at) // dtype.itemsize
            raise DataError(f"it is cut off: {max(there, 0)} of {number} values are there")
        values = np.frombuffer(self.content, dtype, number, self.at)
        self.at += number * dtype.itemsize
        return values

    def _ascii(self, number: int) -> np.ndarray:
        begin = max(self.at - 1, 0)
        following = NEXT_WORD.search(self.content, begin)
        end = following.start() if following else len(self.content)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a word that is no number ends the values: they are counted next
            try:
                values = np.fromstring(self.content[self.at : end].decode("latin-1"), sep=" ")
            except ValueError as error:
                raise DataError(f"among {number} values is a word that is no number") from error
        if values.size != number:
            raise DataError(f"it is cut off or damaged: {values.size} of {number} values are there")
        self.at = end + 1
        return values
