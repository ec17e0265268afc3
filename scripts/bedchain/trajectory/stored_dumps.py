# SPDX-License-Identifier: GPL-3.0-or-later
"""Dumps of a simulation into the trajectory: every frame checked, one in memory at a time."""

import json
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from bedchain.errors import DataError, UserError
from bedchain.files import atomic_file, write_npy_header, write_text
from bedchain.fingerprints import check_fingerprint
from bedchain.trajectory.dumps import frame_of, listed, read_dump
from bedchain.trajectory.realisations import Realisation, open_realisation
from bedchain.trajectory.store import STORED, check_disk, read_manifest, retract, trajectory_metadata

LOG = logging.getLogger(__name__)


def write_trajectory(
    dem: Path, trajectory: Path, metadata: Path, width_m: float, height_m: float, progress: bool = True
) -> dict[str, Any]:
    """Check all frames of a run and write them as one array, with one frame in memory at a time.

    Parameters
    ----------
    dem : Path
        The run's manifest, ``dem.json``; the files of the frames are relative to its folder.
    trajectory : Path
        Gets float32 (n_frames, 4, n_particles): x, z [m], vx, vz [m/s], particles by id; velocities are NaN
        where the dumps have none.
    metadata : Path
        Gets `trajectory_metadata`.
    width_m, height_m : float
        Size of the bed [m].
    progress : bool
        Show a progress bar on stderr.

    Returns
    -------
    dict
        The manifest.

    Raises
    ------
    UserError
        A frame is missing, cut off, or holds other particles than the first, or the dumps have no positions;
        nothing is written.
    """
    manifest = read_manifest(dem)
    if lacking := sorted({"number", "columns"} - manifest.keys()):
        raise DataError(f"{dem} lacks {', '.join(lacking)}; run run_dem again")
    frames, number = manifest["frames"], int(manifest["number"])
    shape, bounds = (len(frames), len(STORED), number), {"x": width_m, "z": height_m}
    check_disk(trajectory, 4 * int(np.prod(shape)))
    ids: np.ndarray | None = None
    columns = manifest["columns"]
    if absent := [name for name in STORED if name not in columns]:
        if not {"x", "z"}.isdisjoint(absent):
            raise UserError(f"the dumps hold {' '.join(columns)}, x and z are needed; write them again")
        LOG.info("no %s in the dumps: models that need velocities take differences of positions", absent)
    # a plain stream: the pages of a memory map would stay in memory until the end
    with atomic_file(trajectory) as temporary, temporary.open("wb") as stream:
        write_npy_header(stream, shape, np.dtype(np.float32))
        for index in tqdm(range(len(frames)), desc="parse_dumps", unit="frame", disable=not progress):
            frame = _read_frame(manifest, index, dem.parent, ids, bounds)
            ids = frame[columns.index("id")].astype(np.int64) if ids is None else ids
            missing = np.full(frame.shape[1], np.nan)
            stored = [frame[columns.index(name)] if name in columns else missing for name in STORED]
            stream.write(np.array(stored, np.float32).tobytes())
    assert ids is not None
    write_text(metadata, json.dumps(trajectory_metadata(manifest, ids, width_m, height_m)))
    return manifest


@contextmanager
def parsed_run(folder: Path, width_m: float, height_m: float) -> Iterator[Realisation]:
    """The frames of a finished run in one file, which is as large as its dumps and goes afterwards.

    Parameters
    ----------
    folder : Path
        With ``dem.json``.
    width_m, height_m : float
        Size of the bed [m].

    Raises
    ------
    DataError, UserError
        As `write_trajectory`.
    """
    trajectory, metadata = folder / "trajectory.npy", folder / "trajectory.json"
    try:
        write_trajectory(folder / "dem.json", trajectory, metadata, width_m, height_m, progress=False)
        yield open_realisation(folder.name, trajectory, metadata)
    finally:
        for file in (trajectory, metadata):
            file.unlink(missing_ok=True)


def _read_frame(
    manifest: dict[str, Any], index: int, folder: Path, ids: np.ndarray | None, bounds: dict[str, float]
) -> np.ndarray:
    """A checked frame; errors name the frame, the file and the way out."""
    entry, columns = manifest["frames"][index], manifest["columns"]
    try:
        if "blake2b" in entry:
            check_fingerprint(folder / entry["file"], {name: entry[name] for name in ("bytes", "blake2b")})
        dump = read_dump(folder / entry["file"], columns)
        if dump.step != entry["step"]:
            raise UserError(f"its step is {dump.step}, {entry['step']} expected")
        if len(dump.values) != manifest["number"]:
            present = dump.values[:, columns.index("id")]
            absent = "" if ids is None else f", missing: id {listed(np.setdiff1d(ids, present))}"
            raise UserError(f"it holds {len(dump.values)} particles, {manifest['number']} expected{absent}")
        return frame_of(dump, columns, ids, bounds)
    except UserError as error:
        wrong = (
            str(error).replace(f"{folder / entry['file']}: ", "").replace(str(folder / entry["file"]), "it")
        )
        way_out = retract(folder / "dem.json", (folder / entry["file"]).parent)
        raise UserError(f"frame {index} of {entry['file']}: {wrong}; {way_out}") from error
