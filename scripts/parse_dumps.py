# SPDX-License-Identifier: GPL-3.0-or-later
"""Every frame of the DEM in one array: results/<case>/trajectory.npy and trajectory.json."""

import json
from pathlib import Path

from bedchain.stage import LOG, complete, stage
from bedchain.trajectory import read_manifest, trajectory_metadata, write_trajectory


def parse_dumps(
    dem: Path, trajectory: Path, metadata: Path, width_m: float, height_m: float, progress: bool = True
) -> None:
    """Check every frame of a run and write them as one array, one frame in memory at a time.

    Parameters
    ----------
    dem : Path
        The run's manifest, ``dem.json``.
    trajectory : Path
        Gets float32 (n_frames, 4, n_particles): x, z [m], vx, vz [m/s], particles by id.
    metadata : Path
        Gets times, ids, rows and the bed's size.
    width_m, height_m : float
        Size of the bed [m].
    progress : bool
        Show a bar with the time left.

    Raises
    ------
    UserError
        A frame is missing, cut off, or holds other particles than the first; nothing is written then.
    """
    manifest = read_manifest(dem)
    bounds = {"x": width_m, "z": height_m}
    ids = write_trajectory(manifest, dem.parent, trajectory, bounds, progress)
    with complete(metadata) as temporary:
        temporary.write_text(json.dumps(trajectory_metadata(manifest, ids, width_m, height_m)))
    LOG.info("%d frames of %d particles in %s", len(manifest["frames"]), ids.size, trajectory)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        parse_dumps(
            Path(snakemake.input.dem),
            Path(snakemake.output.trajectory),
            Path(snakemake.output.metadata),
            snakemake.params.width_m,
            snakemake.params.height_m,
        )
