# SPDX-License-Identifier: GPL-3.0-or-later
"""Results kept between runs of a long stage, in a folder whose name stands for all that they depend on."""

import hashlib
import json
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

from bedchain.files import write_text

Made = TypeVar("Made")

BLOCK_BYTES = 1 << 22
STAMP_DIGITS = 16


def stamp(files: Sequence[Path], values: dict[str, object]) -> str:
    """A short name of the contents of files, of values, and of this library's source.

    Parameters
    ----------
    files : sequence of Path
    values : dict
        Anything that json can hold.

    Returns
    -------
    str
        Hexadecimal; any change of what went in gives another.
    """
    total = hashlib.sha256(json.dumps(values, sort_keys=True).encode())
    for file in [*files, *sorted(Path(__file__).parents[1].rglob("*.py"))]:
        with file.open("rb") as stream:
            while block := stream.read(BLOCK_BYTES):
                total.update(block)
    return total.hexdigest()[:STAMP_DIGITS]


def record_of(folder: Path, key: str) -> Path:
    """File that keeps the result of a key."""
    return folder / f"{hashlib.sha256(key.encode()).hexdigest()[:STAMP_DIGITS]}.json"


def remembered(record: Path, make: Callable[[], Made]) -> Made:
    """A result from its record, or made and recorded; an error leaves no record.

    Parameters
    ----------
    record : Path
        Its name stands for all that the result depends on.
    make : callable
        Gives what json can hold.
    """
    if record.exists():
        found: Made = json.loads(record.read_text(encoding="utf-8"))
        return found
    made = make()
    write_text(record, json.dumps(made, indent=1))
    return made


def only(folder: Path) -> Path:
    """The folder, made where missing, and its neighbours (results of other data or code) removed."""
    if folder.parent.exists():
        for other in folder.parent.iterdir():
            if other != folder and other.is_dir():
                shutil.rmtree(other)
    folder.mkdir(parents=True, exist_ok=True)
    return folder
