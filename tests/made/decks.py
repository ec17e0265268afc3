# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes of LIGGGHTS without gas, from the decks beside this file, as arrays."""

import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.trajectory.dumps import read_dump

DECKS = Path(__file__).with_name("decks")
COLUMNS = ["id", "type", "radius", "x", "y", "z", "vx", "vy", "vz"]
LIMIT_S = 600  # some seconds on an idle core


class Scene(NamedTuple):
    """Frames of a scene; rows x, z, vx, vz, y, NaN where a particle is not there."""

    values: np.ndarray
    type: np.ndarray
    radius_m: np.ndarray


def run_deck(name: str, folder: Path, across: str = "x") -> Scene:
    """Frames of a deck, run in a folder; its direction ``across`` is called x, the other horizontal one y."""
    command = ["liggghts", "-in", str(DECKS / name), "-log", "none"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=LIMIT_S)
    files = sorted(folder.glob("frame_*.dump"), key=lambda file: int(file.stem.split("_")[1]))
    # an empty frame, before anything is fed, has no table to read
    dumps = [read_dump(file, COLUMNS).values for file in files if len(file.read_text().splitlines()) > 9]
    ids = np.unique(np.concatenate([dump[:, 0] for dump in dumps]))
    values = np.full((len(dumps), 5, ids.size), np.nan, np.float32)
    other = "y" if across == "x" else "x"
    rows = [across, "z", f"v{across}", "vz", other]
    kind, radius = np.zeros(ids.size, np.int32), np.zeros(ids.size)
    for frame, dump in zip(values, dumps, strict=True):
        place = np.searchsorted(ids, dump[:, 0])
        frame[:, place] = dump[:, [COLUMNS.index(name) for name in rows]].T
        kind[place], radius[place] = dump[:, 1], dump[:, 2]
    return Scene(values, kind, radius)
