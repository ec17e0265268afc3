# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays read from .npy and .npz files, whose headers are believed only where the size of the file agrees."""

import math
import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from bedchain.errors import DataError, make_again

# what the reading of a damaged array ends in, of numpy, zipfile and their decompressors
ARRAY_FAULTS = (
    *(OSError, ValueError, TypeError, KeyError, EOFError, AttributeError, RuntimeError, OverflowError),
    *(SyntaxError, MemoryError, tokenize.TokenError, struct.error, zipfile.BadZipFile, zlib.error),
)
MOST_DEFLATED = 1032  # bytes that one byte can stand for (zlib's own account, zlib.net/zlib_tech.html)


class Arrays(dict[str, NDArray[Any]]):
    """Arrays of a file by name; one that is not there is an error with the file's name."""

    def __init__(self, path: Path | str, arrays: dict[str, NDArray[Any]]) -> None:
        super().__init__(arrays)
        self.path = path

    def __missing__(self, name: str) -> NDArray[Any]:
        """Refuse the name."""
        raise DataError(f"{self.path} holds no array {name!r}; {make_again(self.path)}")


def read_arrays(path: Path | str, but: str = "") -> Arrays:
    """All arrays of an .npz, but one that is mapped.

    Raises
    ------
    DataError
        The file is missing, cut off, or not an .npz; later, an array that it does not hold.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
            entries.pop(but, None)
            return Arrays(path, {name: _read_entry(archive, entry) for name, entry in entries.items()})
    except ARRAY_FAULTS as error:
        raise DataError(f"{path} cannot be read ({error}); {make_again(path)}") from error


def _read_entry(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> NDArray[Any]:
    packed = entry.compress_size * {zipfile.ZIP_STORED: 1, zipfile.ZIP_DEFLATED: MOST_DEFLATED}.get(
        entry.compress_type, 0
    )
    if entry.file_size > packed or entry.compress_size > Path(str(archive.filename)).stat().st_size:
        raise ValueError(f"{entry.filename} announces {entry.file_size} bytes, more than can be there")
    with archive.open(entry) as stream:
        read_npy_header(stream, entry.file_size)
    with archive.open(entry) as stream:
        array: NDArray[Any] = npy_format.read_array(stream, allow_pickle=False)
        return array


def read_npy_header(stream: IO[bytes], size: int) -> tuple[tuple[int, ...], bool, np.dtype]:
    """Shape, order (True for Fortran's) and type of an .npy; nothing is allocated for them.

    Parameters
    ----------
    stream : binary file
        At its start; afterwards at the first value.
    size : int
        Bytes of the whole .npy.

    Raises
    ------
    ValueError
        The header is none, is of Python objects, or its values are not exactly the other bytes.
    """
    version = npy_format.read_magic(stream)
    read = npy_format.read_array_header_1_0 if version == (1, 0) else npy_format.read_array_header_2_0
    shape, fortran, dtype = read(stream)
    announced = _count(shape) * dtype.itemsize
    if dtype.hasobject or min(shape, default=1) < 0 or (announced == 0 and _count(shape)):
        raise ValueError(f"its header is of {dtype} in the shape {shape}")
    if announced != size - stream.tell():
        raise ValueError(f"its header announces {announced} bytes, {size - stream.tell()} are there")
    return shape, fortran, dtype


def _count(shape: tuple[int, ...]) -> int:
    return math.prod(map(int, shape))


def map_npy(path: Path | str) -> np.memmap:
    """Memory map of an .npy: it need not fit in memory.

    Raises
    ------
    DataError
        The file is missing, cut off, or not an .npy.
    """
    try:
        with open(path, "rb") as stream:
            shape, fortran, dtype = read_npy_header(stream, Path(path).stat().st_size)
            return np.memmap(path, dtype, "r", stream.tell(), shape, "F" if fortran else "C")
    except ARRAY_FAULTS as error:
        raise DataError(f"{path} cannot be read ({error}); {make_again(path)}") from error


def map_array(path: Path | str, name: str) -> np.memmap:
    """Memory map of an array in an uncompressed .npz: it need not fit in memory.

    Raises
    ------
    DataError
        The file holds no such array, or a compressed one.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            entry = archive.getinfo(f"{name}.npy")
            if entry.compress_type != zipfile.ZIP_STORED:
                raise ValueError(f"{name} is compressed: write it with numpy.savez")
            with archive.open(entry) as stream:
                shape, fortran, dtype = read_npy_header(stream, entry.file_size)
                header_bytes = stream.tell()
        with open(path, "rb") as stream:
            # the local header has 30 bytes; the last four are the lengths of the name and of the extra field
            stream.seek(entry.header_offset + 26)
            lengths = np.frombuffer(stream.read(4), "<u2")
        offset = entry.header_offset + 30 + int(lengths.sum()) + header_bytes
        return np.memmap(path, dtype, "r", offset, shape, "F" if fortran else "C")
    except ARRAY_FAULTS as error:
        raise DataError(f"{path}: no array {name!r} can be mapped ({error}); {make_again(path)}") from error
