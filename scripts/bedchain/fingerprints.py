# SPDX-License-Identifier: GPL-3.0-or-later
"""Fingerprints of files, their size and hash: by them a later step knows that a file is as it was made.

The fingerprints of a segment's files are in its record. Those of a stage's outputs are in notes beside them,
``.fingerprints/<name>.json``: a file that was cut off, changed or swapped for another is put aside by its
next reader, so that the same command makes it again. A file without a note, such as a case file, is a user's.
"""

import hashlib
import json
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.errors import DataError, UserError
from bedchain.files import refuse_special_file, write_text

HASH_BYTES = 16  # no two files of a run share so many by accident
# A file of more than so many bytes is noted by blocks that are evenly spread over it, with its first and its
# last: its readers take parts of it, and a whole hash in each stage would cost more than the stage.
WHOLE_BYTES, BLOCK_BYTES = 1 << 24, 1 << 20
NOTES = ".fingerprints"
DAMAGED = ".damaged"
NOTED = (".csv", ".json", ".npy", ".npz")  # what later stages read


def fingerprint_of(path: Path, most_bytes: int | None = None) -> dict[str, Any]:
    """Size and hash of a file: ``bytes`` and ``blake2b``.

    Parameters
    ----------
    path : Path
    most_bytes : int, optional
        A larger file is hashed in so many bytes of blocks, spread over it; None hashes all of it.
    """
    size = path.stat().st_size
    digest = hashlib.blake2b(digest_size=HASH_BYTES)
    with path.open("rb") as stream:
        if most_bytes is None or size <= most_bytes:
            while block := stream.read(BLOCK_BYTES):
                digest.update(block)
        else:
            count = most_bytes // BLOCK_BYTES
            for at in range(count):
                stream.seek((size - BLOCK_BYTES) * at // (count - 1))
                digest.update(stream.read(BLOCK_BYTES))
    return {"bytes": size, "blake2b": digest.hexdigest()}


def check_fingerprint(
    path: Path, fingerprint: Mapping[str, Any], with_hash: bool = True, most_bytes: int | None = None
) -> None:
    """Refuse a file that is not the one that its maker wrote.

    Parameters
    ----------
    path : Path
    fingerprint : mapping
        Of `fingerprint_of`, as the maker noted it.
    with_hash : bool, optional
        Compare the content too, not only the size: about a second for each gigabyte.
    most_bytes : int, optional
        Of `fingerprint_of`.

    Raises
    ------
    DataError
        Names the file and what is wrong.
    """
    try:
        size = path.stat().st_size
        if size < fingerprint["bytes"]:
            raise DataError(f"{path} is cut off: {size} of {fingerprint['bytes']} bytes are there")
        if size > fingerprint["bytes"] or (with_hash and fingerprint_of(path, most_bytes) != fingerprint):
            raise DataError(f"{path} was changed after it was written: its bytes are others")
    except OSError as error:
        raise DataError(f"{path} cannot be read ({error.strerror})") from error


def note_fingerprints(files: Iterable[Path]) -> None:
    """Note the fingerprints of finished files beside them; none of kinds that no later stage reads."""
    for file in files:
        if file.suffix in NOTED and file.exists():
            write_text(note_of(file), json.dumps(fingerprint_of(file, WHOLE_BYTES)))


def note_of(file: Path) -> Path:
    """The note with a file's fingerprint."""
    return file.parent / NOTES / f"{file.name}.json"


def check_noted(files: Iterable[Path]) -> None:
    """Refuse files that are not as their notes say; a damaged one is put aside, to be made again.

    Raises
    ------
    UserError
        Names the file, what is wrong with it, and the way on.
    """
    for file in files:
        try:
            fingerprint = json.loads(note_of(file).read_text(encoding="utf-8"))
            known = isinstance(fingerprint, dict) and fingerprint.keys() == {"bytes", "blake2b"}
        except (OSError, ValueError):  # no note, or one that is damaged itself
            continue
        if known:
            try:
                check_fingerprint(file, fingerprint, most_bytes=WHOLE_BYTES)
            except DataError as error:
                raise UserError(f"{error}; {put_aside(file)}") from error


def put_aside(file: Path) -> str:
    """Give a damaged file another name, so that the next run makes it again; returns what to do."""
    again = "give the same command again, which makes it anew"
    if not file.is_file():
        return f"move away what stands in its place, and {again}" if file.exists() else again
    aside = file.with_name(file.name + DAMAGED)
    file.replace(aside)
    return f"it is called {aside.name} now: {again}"


def unreadable(files: Iterable[Path]) -> tuple[Path, str] | None:
    """The first of some files that cannot be read as what its suffix says, and why; None where all can."""
    for file in files:
        try:
            refuse_special_file(file)
            _read(file)
        except (OSError, ValueError, KeyError, EOFError, RecursionError, zipfile.BadZipFile) as error:
            return file, f"{error}".replace(f"{file}: ", "") or type(error).__name__
    return None


def _read(file: Path) -> None:
    """Read a file to its end, by its suffix."""
    if file.suffix == ".json":
        json.loads(file.read_text(encoding="utf-8"))
    elif file.suffix == ".csv":
        if not file.read_bytes().endswith(b"\n"):
            raise ValueError("it is cut off: its last line has no end")
        import pandas as pd  # late: it takes a third of a second to load, in each stage

        pd.read_csv(file, comment="#")
    elif file.suffix == ".npy":
        np.load(file, mmap_mode="r")
    elif file.suffix == ".npz":
        with zipfile.ZipFile(file) as archive:
            if bad := archive.testzip():
                raise ValueError(f"its part {bad} is damaged")
    else:
        with file.open("rb") as stream:
            stream.read(1)
