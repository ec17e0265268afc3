# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and folders that appear complete or not at all, and a lock on a folder."""

import fcntl
import glob
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError, UserError, world_error
from bedchain.work_folders import OURS, fresh_folder

if TYPE_CHECKING:  # pandas takes a third of a second to load, and stages of arrays alone need none
    import pandas as pd


def write_arrays(path: Path | str, arrays: dict[str, NDArray[Any]]) -> None:
    """Write arrays to an .npz, complete or not at all.

    Parameters
    ----------
    path : path
        File to write.
    arrays : dict of str to array
        Of any type except objects.
    """
    with atomic_file(Path(path)) as temporary, temporary.open("wb") as stream:
        np.savez(stream, allow_pickle=False, **arrays)


def path_inside(folder: Path, name: Any) -> Path:
    """Path of a file or folder that a manifest names, which must be within the manifest's folder.

    Parameters
    ----------
    folder : Path
        Folder of the manifest; it may itself be a link.
    name : str
        Relative path, as the manifest has it; it need not exist.

    Returns
    -------
    Path

    Raises
    ------
    DataError
        The name is no relative path, leads out of the folder (by ``..`` or a link), or is a special file.
    """
    if not isinstance(name, str) or not name or "\0" in name:
        raise DataError(f"{folder}: {name!r} is no name of a file; make the manifest again")
    relative = Path(name)
    if relative.is_absolute() or ".." in relative.parts:
        raise DataError(f"{folder}: {name} is not within this folder; make the manifest again")
    path = folder / relative
    try:
        outside = not path.resolve().is_relative_to(folder.resolve())
        refuse_special_file(path)
    except (OSError, RuntimeError) as error:
        raise DataError(f"{path} cannot be reached ({error}); make the manifest again") from error
    if outside:
        raise DataError(f"{path} is a link to {path.resolve()}, out of {folder}; put the file itself there")
    return path


def refuse_special_file(path: Path) -> None:
    """Refuse a pipe, socket or device, whose reading may never end; a missing file passes.

    Raises
    ------
    DataError
        It is one.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise DataError(f"{path} is a special file (pipe, socket or device), not data; move it away")


CSV_DIGITS = "%.8g"
LOCK_PATIENCE_S = 20.0  # more than mpirun takes to end its ranks


@contextmanager
def atomic_file(target: Path) -> Iterator[Path]:
    """A temporary file beside ``target``: moved to ``target`` after success, removed after an error.

    Parameters
    ----------
    target : Path
        Its folder is created where missing.

    Yields
    ------
    Path
        Has the suffix of ``target``, from which some writers take the format.
    """
    temporary = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        _remove_left_over(target)
        yield temporary
        sync(temporary)
        temporary.replace(target)
    except OSError as error:
        # a stream that is full names no file, one by its temporary name is the target
        if error.filename not in (None, str(temporary)):
            raise
        error.filename = None
        if sentence := world_error(error, target):
            raise sentence from error
        raise
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _remove_left_over(target: Path) -> None:
    """Remove the temporary files of processes that were killed while they wrote the same target."""
    for file in target.parent.glob(f".{glob.escape(target.stem)}.*{glob.escape(target.suffix)}"):
        process = file.name[len(target.stem) + 2 : len(file.name) - len(target.suffix)]
        if process.isdecimal() and not _is_alive(process):
            file.unlink(missing_ok=True)


def sync(file: Path) -> None:
    """Have the system write a file's contents to the disk."""
    with file.open("rb") as stream:
        os.fsync(stream.fileno())


def write_text(target: Path, text: str) -> None:
    """Write a text in UTF-8, complete or not at all."""
    with atomic_file(target) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_npy_header(stream: IO[bytes], shape: tuple[int, ...], dtype: np.dtype) -> None:
    """Write the header of an .npy file; its values follow as bytes, in C order, in parts.

    Parameters
    ----------
    stream : binary file
    shape : tuple of int
        Shape of the whole array.
    dtype : dtype
    """
    header = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, header)


def write_csv(table: "pd.DataFrame", target: Path) -> None:
    """Write a table as csv, complete or not at all.

    Parameters
    ----------
    table : DataFrame
        Its column names end in the units.
    target : Path
    """
    with atomic_file(target) as temporary:
        table.to_csv(temporary, index=False, float_format=CSV_DIGITS)


@contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Lock a folder for one process and the solvers that inherit the lock; it ends with the last of them.

    Of a process that was killed the solvers may need seconds to end: the next one waits for that.

    Raises
    ------
    UserError
        Another process holds the lock.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("a+", encoding="utf-8") as lock:
        os.set_inheritable(lock.fileno(), True)
        lock.seek(0)
        holder = lock.read().strip()
        if not _locked(lock, 0 if _is_alive(holder) else LOCK_PATIENCE_S):
            raise UserError(
                f"{folder} is in use by process {holder}: wait for it, or end it with kill {holder}"
            )
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


def _locked(lock: IO[str], patience_s: float) -> bool:
    """Lock a file; False if another process still has it at the end of the patience."""
    last = time.monotonic() + patience_s
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if time.monotonic() >= last:
                return False
            time.sleep(0.1)


def _is_alive(process: str) -> bool:
    return process.isdecimal() and Path("/proc", process).exists()


@contextmanager
def atomic_folder(target: Path) -> Iterator[Path]:
    """A work folder that becomes ``target`` if the work succeeds; the remains of a failed try are removed."""
    part = fresh_folder(target.with_name(target.name + ".part"))
    yield part
    for file in part.rglob("*"):
        if file.is_file():
            sync(file)
    os.replace(part, target)
    (target / OURS).unlink()
