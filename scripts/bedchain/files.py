# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and folders that appear complete or not at all, and the lock of a folder."""

import fcntl
import os
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
import pandas as pd
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from bedchain.errors import DataError, UserError


def write_arrays(path: Path | str, arrays: dict[str, NDArray[Any]]) -> None:
    """Write arrays to an .npz, complete or not at all.

    Parameters
    ----------
    path : path
        File to make.
    arrays : dict of str to array
        Anything but objects.
    """
    with complete(Path(path)) as temporary, temporary.open("wb") as stream:
        np.savez(stream, allow_pickle=False, **arrays)


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


CSV_DIGITS = "%.8g"


@contextmanager
def complete(target: Path) -> Iterator[Path]:
    """A temporary name beside ``target`` to write to; moved to ``target`` if all went well, removed if not.

    Parameters
    ----------
    target : Path
        Its folder is made where missing.

    Yields
    ------
    Path
        With the suffix of ``target``, so that writers that look at it do the right thing.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    try:
        yield temporary
        sync(temporary)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def sync(file: Path) -> None:
    """Have the system write a file's contents to the disk."""
    with file.open("rb") as stream:
        os.fsync(stream.fileno())


def write_text(target: Path, text: str) -> None:
    """Write a text in UTF-8, complete or not at all."""
    with complete(target) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_npy_header(stream: IO[bytes], shape: tuple[int, ...], dtype: np.dtype) -> None:
    """Begin an .npy file whose values follow as bytes, in C order, a part at a time.

    Parameters
    ----------
    stream : binary file
    shape : tuple of int
        Of the whole array.
    dtype : dtype
    """
    described = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, described)


def write_csv(table: pd.DataFrame, target: Path) -> None:
    """Write a table as csv, complete or not at all.

    Parameters
    ----------
    table : DataFrame
        Units stand in the names of the columns.
    target : Path
    """
    with complete(target) as temporary:
        table.to_csv(temporary, index=False, float_format=CSV_DIGITS)


@contextmanager
def exclusive(folder: Path) -> Iterator[None]:
    """Hold `folder` for one run at a time; the lock goes with the process, however it ends.

    Raises
    ------
    UserError
        Where another process holds it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("a+", encoding="utf-8") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            holder = lock.read().strip()
            raise UserError(
                f"{folder} is in use by process {holder}: wait for it, or end it with kill {holder}"
            ) from None
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


@contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """A folder to work in that becomes `target` only if the work succeeds; a torn one is cleared first."""
    part = target.with_name(target.name + ".part")
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    yield part
    for file in part.rglob("*"):
        if file.is_file():
            sync(file)
    os.replace(part, target)
