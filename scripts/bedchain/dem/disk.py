# SPDX-License-Identifier: GPL-3.0-or-later
"""Disk space that a simulation takes, asked for before it starts."""

import math
import shutil
from pathlib import Path

from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import ratio

DUMP_COLUMNS = {"one": 5, "many": 7}  # id x z vx vz, and y vy, by bed.layers
DOUBLE_BYTES = 8
TRAJECTORY_BYTES = 4 * 4  # x z vx vz in single precision, the store made of the frames
CELL_BYTES = 4  # an int32 for each particle and frame
RESTART_BYTES_PARTICLE = 500  # measured 480: a LIGGGHTS restart, with the history of a particle's contacts
RESTART_BYTES_GAS_CELL = 500  # measured 490: mesh and fields of a segment
MARGIN = 1.1  # file system blocks, logs, figures


def run_bytes(case: Case) -> int:
    """Bytes that a case takes on disk: frames, the stores made of them, and a restart of each segment.

    Parameters
    ----------
    case : dict
        A checked case, of `case.load.load_case`.
    """
    time, bed = case["time"], case["bed"]
    frames = int(ratio(time["end_s"], time["frame_interval_s"])) + 1
    number = case["particles"]["number"]
    cell = case["gas"]["cell_size_m"]
    depth_cells = max(1.0, bed["thickness_m"] / cell) if bed["layers"] == "many" else 1.0
    gas_cells = bed["width_m"] * bed["height_m"] / cell**2 * depth_cells
    frame_bytes = number * (DUMP_COLUMNS[bed["layers"]] * DOUBLE_BYTES + TRAJECTORY_BYTES + CELL_BYTES)
    segments = math.ceil(ratio(time["end_s"], time["segment_s"])) + 1
    restart_bytes = number * RESTART_BYTES_PARTICLE + gas_cells * RESTART_BYTES_GAS_CELL
    return int(MARGIN * (frames * frame_bytes + segments * restart_bytes))


def require_disk(folder: Path, needed: int, done: int = 0) -> None:
    """Refuse to start where the disk is too full.

    Parameters
    ----------
    folder : Path
        Where the results go; an existing folder.
    needed : int
        Bytes that the run takes in all.
    done : int, optional
        Bytes of it that are there already.

    Raises
    ------
    UserError
        Names the folder, the space needed and free, and the remedy.
    """
    free = shutil.disk_usage(folder).free
    if needed - done > free:
        raise UserError(
            f"{folder}: the run needs {(needed - done) / 1e6:.0f} MB on disk, {free / 1e6:.0f} MB are free; "
            "free some space, let results/ point to a larger disk, "
            "or in the case take a shorter time.end_s or a longer time.frame_interval_s"
        )
