# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders to work in, marked as bedchain's: only these are ever emptied or removed."""

import shutil
from pathlib import Path

from bedchain.errors import UserError

# In each folder that may be emptied again; a log, not data, to all who list a folder.
OURS = ".made_by_bedchain.log"
ABOUT_OURS = (
    "This folder was made by bedchain, which removes it with all that is in it when it needs it no more.\n"
)


def work_folder(folder: Path) -> Path:
    """A folder to work in, marked as bedchain's, so that `discard_folder` may remove it.

    Parameters
    ----------
    folder : Path
        Made where missing; an empty one becomes bedchain's, one that is marked stays as it is.

    Raises
    ------
    UserError
        It holds something that bedchain did not make, or is no folder.
    """
    if not _is_ours(folder):
        _refuse_if_used(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / OURS).write_text(ABOUT_OURS, encoding="utf-8")
    return folder


def fresh_folder(folder: Path) -> Path:
    """A `work_folder` that is empty: what an earlier run of bedchain left in it is removed.

    Raises
    ------
    UserError
        As `work_folder`.
    """
    discard_folder(folder)
    return work_folder(folder)


def discard_folder(folder: Path) -> None:
    """Remove a `work_folder` with all that is in it; a missing or an empty folder passes.

    Raises
    ------
    UserError
        It holds something that bedchain did not make, or is no folder.
    """
    if not _is_ours(folder):
        _refuse_if_used(folder)
    if not folder.exists():
        return
    for item in folder.iterdir():
        if item.is_dir() and not item.is_symlink():
            shutil.rmtree(item)
        elif item.name != OURS:
            item.unlink()
    (folder / OURS).unlink(missing_ok=True)  # last, so that a kill leaves a folder that can still be removed
    folder.rmdir()


def _is_ours(folder: Path) -> bool:
    """Whether a folder is marked, or stands in one that is."""
    marked = any((place / OURS).is_file() for place in (folder, folder.parent))
    return folder.is_dir() and not folder.is_symlink() and marked


def _refuse_if_used(folder: Path) -> None:
    if folder.is_symlink() or (folder.exists() and not (folder.is_dir() and not any(folder.iterdir()))):
        raise UserError(
            f"{folder} is needed as a folder to work in, and was not made by bedchain (no {OURS} in it): "
            "it stays as it is; move it away, or take another folder"
        )
