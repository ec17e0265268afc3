# SPDX-License-Identifier: GPL-3.0-or-later
"""Every frame of the DEM in one array: results/<case>/trajectory.npy and trajectory.json."""

from pathlib import Path

from bedchain.stage import LOG, run_stage
from bedchain.trajectory.stored_dumps import write_trajectory


def parse_dumps(
    dem: Path, trajectory: Path, metadata: Path, width_m: float, height_m: float, progress: bool = True
) -> None:
    """`trajectory.write_trajectory`, and what was written in the log."""
    manifest = write_trajectory(dem, trajectory, metadata, width_m, height_m, progress)
    LOG.info("%d frames of %d particles in %s", len(manifest["frames"]), manifest["number"], trajectory)


if rule := globals().get("snakemake"):
    run_stage(parse_dumps, rule)
