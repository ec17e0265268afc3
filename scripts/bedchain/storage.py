# SPDX-License-Identifier: GPL-3.0-or-later
"""Named arrays in a file that appears whole or not at all."""

import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from bedchain.frames import DataError


def write_arrays(path: Path | str, arrays: dict[str, NDArray[Any]]) -> None:
    """Write arrays to an .npz under a temporary name, then move it into place.

    Parameters
    ----------
    path : path
        File to make; its folder exists.
    arrays : dict of str to array
        Anything but objects.
    """
    target = Path(path)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        with temporary.open("wb") as stream:
            np.savez(stream, allow_pickle=False, **arrays)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)


def read_arrays(path: Path | str) -> dict[str, NDArray[Any]]:
    """All arrays of an .npz.

    Raises
    ------
    DataError
        The file is missing, cut off, or no .npz.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, AttributeError) as error:
        raise DataError(f"{path} cannot be read ({error}): make it again") from error


def map_array(path: Path | str, name: str) -> np.memmap:
    """Memory map of one array inside an uncompressed .npz, so that it need not fit in memory.

    Raises
    ------
    DataError
        The file holds no such array, or a compressed one.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            entry = archive.getinfo(f"{name}.npy")
    except (OSError, KeyError, zipfile.BadZipFile) as error:
        raise DataError(f"{path} holds no array {name!r} ({error}): make it again") from error
    if entry.compress_type != zipfile.ZIP_STORED:
        raise DataError(f"{path}: {name} is compressed and cannot be mapped: write it with numpy.savez")
    with open(path, "rb") as stream:
        # A local header of 30 bytes, whose last four give the lengths of the name and of the extra field.
        stream.seek(entry.header_offset + 26)
        lengths = np.frombuffer(stream.read(4), "<u2")
        stream.seek(entry.header_offset + 30 + int(lengths.sum()))
        version = npy_format.read_magic(stream)
        read = npy_format.read_array_header_1_0 if version == (1, 0) else npy_format.read_array_header_2_0
        shape, fortran, dtype = read(stream)
        offset = stream.tell()
    return np.memmap(path, dtype, "r", offset, shape, "F" if fortran else "C")
