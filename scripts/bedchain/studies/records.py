# SPDX-License-Identifier: GPL-3.0-or-later
"""Records: results kept between runs of a long stage, in a folder named by all that they depend on."""

import hashlib
import json
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from bedchain.files import write_text

Result = TypeVar("Result")

BLOCK_BYTES = 1 << 22
STAMP_DIGITS = 16
STAMP = re.compile(rf"[0-9a-f]{{{STAMP_DIGITS}}}")
RECORD = re.compile(rf"\.?{STAMP.pattern}(\.[0-9]+)?\.json")  # also of a write that was killed


def stamp(files: Sequence[Path], values: dict[str, object]) -> str:
    """Digest of the contents of files, of values, and of the source of this library.

    Parameters
    ----------
    files : sequence of Path
    values : dict
        Anything that json can hold.

    Returns
    -------
    str
        Hexadecimal; any change of these gives another.
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


def remembered(record: Path, make: Callable[[], Result]) -> Result:
    """A result read from its record; it is made and recorded where there is no record, or a damaged one.

    An error leaves no record.

    Parameters
    ----------
    record : Path
        Named by all that the result depends on.
    make : callable
        Returns a result that json can hold.
    """
    with suppress(FileNotFoundError, ValueError):
        recorded: Result = json.loads(record.read_text(encoding="utf-8"))
        return recorded
    result = make()
    write_text(record, json.dumps(result, indent=1))
    return result


def remove_other_results(folder: Path) -> Path:
    """Remove the records in folders beside this one (results of other data or code); make it and return it.

    Only files and folders that are named as records are go: anything else beside them stays.
    """
    for other in sorted(folder.parent.glob("*")):
        if other != folder and STAMP.fullmatch(other.name) and other.is_dir() and not other.is_symlink():
            for file in other.iterdir():
                if RECORD.fullmatch(file.name):
                    file.unlink()
            if not any(other.iterdir()):
                other.rmdir()
    folder.mkdir(parents=True, exist_ok=True)
    return folder
