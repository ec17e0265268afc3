# SPDX-License-Identifier: GPL-3.0-or-later
"""Results kept between runs of a long stage, in a folder whose name stands for all that they depend on."""

import hashlib
import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

BLOCK_BYTES = 1 << 22
STAMP_DIGITS = 16


def stamp(files: Sequence[Path], values: dict[str, Any]) -> str:
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
    for file in [*files, *sorted(Path(__file__).parent.glob("*.py"))]:
        with file.open("rb") as stream:
            while block := stream.read(BLOCK_BYTES):
                total.update(block)
    return total.hexdigest()[:STAMP_DIGITS]


def only(folder: Path) -> Path:
    """The folder, made where missing, and its neighbours (results of other data or code) removed."""
    if folder.parent.exists():
        for other in folder.parent.iterdir():
            if other != folder and other.is_dir():
                shutil.rmtree(other)
    folder.mkdir(parents=True, exist_ok=True)
    return folder
