# SPDX-License-Identifier: GPL-3.0-or-later
"""The archived bed as if just simulated: trajectory, manifest, series, gas and the repeats' curves."""

import json
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.files import atomic_file, write_csv, write_npy_header, write_text
from bedchain.stage import LOG, run_stage
from bedchain.trajectory import archive
from bedchain.trajectory.packed_positions import read_levels, with_velocities
from bedchain.trajectory.store import STORED, trajectory_metadata


def unpack_reference(
    provenance: Path, dem: Path, bed_series: Path, gas: Path, trajectory: Path, metadata: Path,
    repeats: Sequence[Path],
) -> None:  # fmt: skip
    """Check the archive's files and write what a simulation would have left behind.

    Parameters
    ----------
    provenance : Path
        ``provenance.json`` of the archive, ``cases/<case>/reference``.
    dem, bed_series, gas, trajectory, metadata : Path
        ``dem.json``, ``bed_series.csv``, ``gas.npz``, ``trajectory.npy``, ``trajectory.json`` to make;
        velocities are differences of the positions of the frames before and after.
    repeats : sequence of Path
        ``mixing.csv`` of each repeat to make, in order of their numbers.

    Raises
    ------
    UserError
        A file is missing or corrupted; nothing is written then.
    """
    folder = provenance.parent
    found = archive.read_provenance(folder)
    archive.check_files(folder, found)
    step_s, interval_s = found["dem"]["dem_step_s"], found["dem"]["frame_interval_s"]
    number = found["trajectory"]["number"]
    frames = [{"step": step, "time_s": step * step_s, "file": archive.POSITIONS} for step in found["steps"]]
    manifest = found["dem"] | {"frames": frames, "gas": gas.name}
    levels = read_levels(folder / archive.POSITIONS, len(frames), number)
    with atomic_file(trajectory) as temporary, temporary.open("wb") as stream:
        write_npy_header(stream, (len(frames), len(STORED), number), np.dtype(np.float32))
        for frame in with_velocities(levels, found["level_m"], interval_s):
            stream.write(frame.tobytes())
    bed = found["trajectory"]
    described = trajectory_metadata(manifest, np.array(bed["ids"]), bed["width_m"], bed["height_m"])
    described["number"] = number
    for target, content in ((metadata, described), (dem, manifest)):
        write_text(target, json.dumps(content))
    for name, target in ((archive.SERIES, bed_series), (archive.GAS, gas)):
        with atomic_file(target) as temporary:
            shutil.copyfile(folder / name, temporary)
    curves = pd.read_csv(folder / archive.REPEATS)
    for at, target in enumerate(repeats, 1):
        write_csv(curves[curves["source"] == f"dem_{at}"], target)
    LOG.info("%d frames of %d particles and %d repeats from %s", len(frames), number, len(repeats), folder)


if rule := globals().get("snakemake"):
    run_stage(unpack_reference, rule)
