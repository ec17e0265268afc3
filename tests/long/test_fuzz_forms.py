# SPDX-License-Identifier: GPL-3.0-or-later
"""Each form of somebody else's frames, in thousands of damaged files: read or refused, in little memory."""

import gzip
import os
from pathlib import Path
from random import Random

import numpy as np
import pytest

from bedchain.trajectory.bed_frames import Placement, bed_frame
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.frame_files import FrameSettings, loaded
from bedchain.trajectory.survey import survey
from made.damaged import Target, try_damaged
from made.forms import COLUMNS, STEP_S, moving, write_form
from made.mutations import mutated

TIMES = int(os.environ.get("BEDCHAIN_FUZZ", "10_000"))  # of each form; 100 000 take an hour and more [1]
SERIES = moving(n_frames=2, n_particles=4)  # small files: a damage takes about 1 ms
FORMS = (
    "text",
    "many_text",
    "binary",
    "lammps",
    "vtk",
    "vtk_binary",
    "table",
    "npz",
    "gz",
    "vtk_5_ascii",
    "vtk_5_binary",
    "vtp",
    "vtu",
)
PLACE = Placement("x", "z", (0.0, 0.0, 0.0), 1.0, 1.0, outside="exit", without_ids="order")


def read(path: Path) -> None:
    """Everything that an import reads of a file."""
    names = COLUMNS if path.suffix == ".bin" else None
    settings = FrameSettings(str(path), STEP_S, reading=FormSettings(names=names))
    frames = survey(settings, Path())
    for entry, values in loaded(frames.entries, settings):
        with np.errstate(over="ignore"):  # a number that single precision cannot hold is refused later
            bed_frame(values, settings, PLACE, entry.file)


def inside(content: bytes, random: Random) -> bytes:
    """A gz file with damage inside it or outside."""
    if random.random() < 0.3:
        return mutated(content, random)
    return gzip.compress(mutated(gzip.decompress(content), random), compresslevel=1)


def target(form: str, folder: Path) -> Target:
    """The first file of a form."""
    write_form(form, folder, SERIES)
    first = min(file for file in folder.iterdir() if file.suffix != ".pvd")
    content = first.read_bytes()
    return Target(
        first.name, lambda file: file.write_bytes(content), read, inside if form == "gz" else mutated
    )


@pytest.mark.parametrize("form", FORMS)
def test_a_damaged_file_is_read_or_refused_by_a_sentence(tmp_path, form):
    (folder := tmp_path / "files").mkdir()
    try_damaged(target(form, tmp_path / "whole"), form, TIMES, folder)
