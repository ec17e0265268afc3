# SPDX-License-Identifier: GPL-3.0-or-later
"""The trajectory: one array of all frames of a bed, and its metadata.

``trajectory.npy`` is float32 (n_frames, n_rows, n_particles). ``trajectory.json`` names the rows in
``columns``: x, z [m], vx, vz [m/s] always, in this order, then y [m] where the case keeps the third axis,
from 0 to ``depth_m``. Lengths start at the bed's left, front, bottom corner. Velocities are NaN where the
source has none.

A particle has the same place in all frames. Where particles come and go, a particle that is not in a frame
is NaN in all rows of it, and ``complete`` of the metadata is false (true where it is missing); positions
outside the bed are then stored as they are. ``frame_interval_s`` is null where the times are uneven.

Imported frames also leave ``particles.npz`` beside the trajectory: ``ids`` (n_particles,) int64, ascending,
and where the source has them ``type`` int32 and ``radius_m`` float32, which do not change in time. Of a
simulated bed the file does not exist: all its particles are alike.
"""

import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from bedchain.array_files import map_npy
from bedchain.errors import DataError, UserError, make_again
from bedchain.files import path_inside, refuse_special_file

STORED = ("x", "z", "vx", "vz")
RECORD = "segment.json"  # of a segment of a DEM run, in its folder
# share of an interval: frames are multiples of the DEM step, their times differ by round-off only
TIME_TOLERANCE = 1e-6
# what the reading of a damaged json file, and of values in it, ends in
JSON_FAULTS = (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError, AttributeError)
DISK_RESERVE_BYTES = 50_000_000


@dataclass(frozen=True)
class BedFiles:
    """A trajectory on disk, and the cells of its particles.

    Attributes
    ----------
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json``.
    cells : Path, optional
        ``cells.npz``, where they are needed.
    """

    trajectory: Path
    metadata: Path
    cells: Path | None = None

    def open(self) -> tuple[np.ndarray, dict[str, Any]]:
        """See `open_trajectory`."""
        return open_trajectory(self.trajectory, self.metadata)


def read_manifest(path: Path) -> dict[str, Any]:
    """Manifest of a DEM run, its frames checked for order and even spacing.

    Parameters
    ----------
    path : Path
        ``dem.json``; the files of the frames are relative to its folder.

    Returns
    -------
    dict

    Raises
    ------
    UserError
        The manifest is unreadable, empty, or a frame is missing, doubled or out of order; or a file or folder
        that it names is a special file or out of its folder.
    """
    refuse_special_file(path)
    try:
        manifest = json.loads(path.read_text())
        steps = np.array([frame["step"] for frame in manifest["frames"]], np.int64)
        times = np.array([frame["time_s"] for frame in manifest["frames"]], float)
        interval = float(manifest["frame_interval_s"])
        columns, number = manifest.get("columns", ["id"]), manifest.get("number", 1)
        words = isinstance(columns, list) and all(isinstance(name, str) for name in columns)
        if not words or "id" not in columns or type(number) is not int or number < 1:
            raise ValueError(f"{number!r} particles with the columns {columns!r}")
        if not (0 < interval < np.inf and np.isfinite(times).all()):
            raise ValueError(f"a frame interval of {interval} s")
        names = [frame["file"] for frame in manifest["frames"]]
        names += [segment["folder"] for segment in manifest.get("segments", [])]
        names += [manifest["gas"]] if "gas" in manifest else []
        names = list(dict.fromkeys(names))
    except JSON_FAULTS as error:
        raise UserError(
            f"{path}: no readable manifest of a DEM run ({error!r}); run run_dem again"
        ) from error
    for name in names:
        path_inside(path.parent, name)
    if steps.size < 2:
        raise UserError(f"{path}: lists {steps.size} frames, at least 2 are needed; simulate longer")
    uneven = np.flatnonzero(np.abs(np.diff(times) - interval) > TIME_TOLERANCE * interval * steps.size)
    backward = np.flatnonzero(np.diff(steps) <= 0)
    for frame in [*backward, *uneven][:1]:
        before, after = (f"{at} (step {steps[at]}, {times[at]:g} s)" for at in (frame, frame + 1))
        raise UserError(
            f"{path}: frame {after} follows frame {before}, not one interval of {interval:g} s later; "
            f"{make_again(path)}"
        )
    return manifest


def retract(dem: Path, segment: Path) -> str:
    """Take back that a segment is finished, so that the next run makes it again; returns what to do.

    Its record gets another name and the run's manifest goes. A folder that is no segment stays as it is: its
    frames came from elsewhere.

    Parameters
    ----------
    dem : Path
        The run's manifest, ``dem.json``.
    segment : Path
        Folder of the segment.
    """
    record = segment / RECORD
    if not record.exists():
        return f"put whole frames into {segment}, or simulate again into an empty folder"
    record.replace(record.with_name(f"{RECORD}.damaged"))
    dem.unlink(missing_ok=True)
    return f"give the same command again: it makes {segment.name} again from the one before it"


def trajectory_metadata(
    manifest: dict[str, Any], ids: np.ndarray, width_m: float, height_m: float
) -> dict[str, Any]:
    """Metadata of a trajectory: times, ids, rows, size of the bed.

    Parameters
    ----------
    manifest : dict
        Of `read_manifest`.
    ids : (n_particles,) ndarray of int64
        Ascending.
    width_m, height_m : float
        Size of the bed [m].

    Returns
    -------
    dict
        Ready for ``json.dump``.
    """
    return {
        "times_s": [frame["time_s"] for frame in manifest["frames"]],
        "steps": [frame["step"] for frame in manifest["frames"]],
        "ids": [int(ids[0]), int(ids[-1])],
        "number": int(ids.size),
        "columns": list(STORED),
        "units": ["m", "m", "m/s", "m/s"],
        "frame_interval_s": manifest["frame_interval_s"],
        "width_m": width_m,
        "height_m": height_m,
        **{key: manifest[key] for key in ("particles_per_parcel",) if manifest.get(key, 1) != 1},
    }


def open_trajectory(path: Path, metadata_path: Path) -> tuple[np.ndarray, dict[str, Any]]:
    """Memory map of a trajectory and its metadata.

    Parameters
    ----------
    path, metadata_path : Path
        ``trajectory.npy`` and ``trajectory.json``.

    Returns
    -------
    (n_frames, n_rows, n_particles) ndarray of float32
        Rows x, z [m], vx, vz [m/s], then those that ``columns`` of the metadata names.
    dict
        As `trajectory_metadata`.
    """
    metadata = _read_metadata(metadata_path)
    store = map_npy(path)
    shape = (len(metadata["times_s"]), len(metadata["columns"]), metadata["number"])
    if store.shape != shape:
        raise UserError(f"{path} has the shape {store.shape}, {shape} expected; {make_again(path)}")
    return store, metadata


def _read_metadata(path: Path) -> dict[str, Any]:
    try:
        metadata = json.loads(path.read_text(encoding="utf-8"))
        sizes = np.array([metadata["width_m"], metadata["height_m"]], float)
        if not np.isfinite([*np.array(metadata["times_s"], float), *sizes]).all() or sizes.min() <= 0:
            raise ValueError("times and sizes must be numbers")
        if not {"x", "z"} <= set(metadata["columns"]) or not isinstance(metadata["columns"], list):
            raise ValueError(f"the rows are {metadata['columns']}")
        _ = metadata["number"], metadata["frame_interval_s"]
        return dict(metadata)
    except JSON_FAULTS as error:
        raise DataError(f"{path} cannot be read ({error!r}); {make_again(path)}") from error


def check_disk(target: Path, size: int) -> None:
    """Refuse to start a file for which there is no room on its disk.

    Parameters
    ----------
    target : Path
    size : int
        Of the file [bytes].

    Raises
    ------
    UserError
        There is less free.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    needed, free = size + DISK_RESERVE_BYTES, shutil.disk_usage(target.parent).free
    if free < needed:
        needed_size, free_size = (tqdm.format_sizeof(number, "B") for number in (needed, free))
        raise UserError(
            f"{target.parent}: {free_size} free, {needed_size} needed for {target.name}; "
            "free disk space and run again"
        )
