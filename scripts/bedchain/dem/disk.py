# SPDX-License-Identifier: GPL-3.0-or-later
"""Disk space that a simulation needs, and its check before the start."""

import math
import shutil
from pathlib import Path

from tqdm import tqdm

from bedchain.case.parcels import parcel_case
from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import ratio

DUMP_COLUMNS = {"one": 5, "many": 7}  # id x z vx vz, and y vy, by bed.layers
DOUBLE_BYTES = 8
TRAJECTORY_BYTES = 4 * 4  # x z vx vz in single precision: trajectory.npy
CELL_BYTES = 4  # an int32 for each particle and frame
RESTART_BYTES_PARTICLE = 500  # measured 480: LIGGGHTS restart with the history of the contacts
RESTART_BYTES_GAS_CELL = 500  # measured 490: mesh and fields of a segment
MARGIN = 1.1  # file system blocks, logs, figures


def run_bytes(case: Case) -> int:
    """Bytes that a case and its repeats need on disk: frames, trajectory, cells, a restart of each segment.

    Parameters
    ----------
    case : dict
        A checked case, of `case.load.load_case`.
    """
    case = parcel_case(case)
    time, bed = case["time"], case["bed"]
    window_s = case["comparison"]["end_s"] - case["comparison"]["start_s"]
    spans_s = [time["end_s"], *[window_s] * case["comparison"]["repeats"]]
    frames = sum(int(ratio(span_s, time["frame_interval_s"])) + 1 for span_s in spans_s)
    number = case["particles"]["number"]
    cell = case["gas"]["cell_size_m"]
    depth_cells = max(1.0, bed["thickness_m"] / cell) if bed["layers"] == "many" else 1.0
    gas_cells = bed["width_m"] * bed["height_m"] / cell**2 * depth_cells
    frame_bytes = number * (DUMP_COLUMNS[bed["layers"]] * DOUBLE_BYTES + TRAJECTORY_BYTES + CELL_BYTES)
    segments = sum(math.ceil(ratio(span_s, time["segment_s"])) + 1 for span_s in spans_s)
    restart_bytes = number * RESTART_BYTES_PARTICLE + gas_cells * RESTART_BYTES_GAS_CELL
    return int(MARGIN * (frames * frame_bytes + segments * restart_bytes))


def require_disk(folder: Path, needed: int, done: int = 0) -> None:
    """Refuse a run that does not fit on the disk.

    Parameters
    ----------
    folder : Path
        Folder of the results; exists.
    needed : int
        Bytes of the complete run.
    done : int, optional
        Bytes of it that are already there.

    Raises
    ------
    UserError
        The disk has too little free space.
    """
    free = shutil.disk_usage(folder).free
    if needed - done > free:
        needed_size, free_size = (tqdm.format_sizeof(size, "B") for size in (needed - done, free))
        raise UserError(
            f"{folder}: the run needs {needed_size} on disk, {free_size} are free; "
            "free some space, let results/ point to a larger disk, "
            "or in the case take a shorter time.end_s or a longer time.frame_interval_s"
        )
