# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed for other people's viewers, in results/<case>/export.

usage: ./run export CASE

bed.pvd and frames/*.vtp for ParaView, frames.dump (LAMMPS text) for OVITO, chain_<model>.vti with the
batch of Figs. 3 and 4 in the cells at each moment, gas/<segment>/gas.foam of a simulated bed for ParaView.
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista

from bedchain.array_files import read_arrays
from bedchain.case.particle_free import require_particles
from bedchain.errors import UserError, report_user_errors
from bedchain.files import atomic_file, write_text
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import open_trajectory, read_manifest

LINE = '<DataSet timestep="{time:g}" file="frames/{number:05d}.vtp"/>'
INDEX = '<VTKFile type="Collection" version="0.1">\n<Collection>\n{lines}\n</Collection>\n</VTKFile>\n'


def export_bed(results: Path) -> Path:
    """Write everything that viewers read of a bed.

    Parameters
    ----------
    results : Path
        ``results/<case>``, with its trajectory and cells.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    UserError
        The case was not run.
    """
    if not (results / "trajectory.npy").exists():
        raise UserError(f"{results} has no trajectory: ./run --config case={results.name} first")
    folder = results / "export"
    (folder / "frames").mkdir(parents=True, exist_ok=True)
    values, described = open_trajectory(results / "trajectory.npy", results / "trajectory.json")
    times = described["times_s"]
    for number, frame in enumerate(values):
        particles(np.asarray(frame)).save(folder / "frames" / f"{number:05d}.vtp")
    lines = [LINE.format(time=time, number=number) for number, time in enumerate(times)]
    write_text(folder / "bed.pvd", INDEX.format(lines="\n".join(lines)))
    write_dump(folder / "frames.dump", values, described)
    grid = open_cells(results / "cells.npz").grid
    for chain in sorted(results.glob("chain_*.npz")):
        arrays = read_arrays(chain)
        if arrays["batch_share"].shape[1] == grid.n_cells:
            densities(grid, arrays["moments_s"], arrays["batch_share"]).save(folder / f"{chain.stem}.vti")
    for segment in read_manifest(results / "dem.json")["segments"] if (results / "dem.json").exists() else []:
        if (gas := results / segment["folder"] / "gas").exists():
            link_gas(gas, folder / "gas" / Path(segment["folder"]).name)
    return folder


def link_gas(case: Path, folder: Path) -> None:
    """An OpenFOAM case as ParaView opens it: links to its parts, and an empty file beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    for part in case.iterdir():
        if not (folder / part.name).is_symlink():
            (folder / part.name).symlink_to(part.resolve())
    (folder / "gas.foam").touch()


def particles(frame: np.ndarray) -> pyvista.PolyData:
    """Particles of a frame, rows x, z, vx, vz, as points with a velocity [m], [m/s]."""
    x, z, vx, vz = frame[:4].astype(np.float32)
    cloud = pyvista.PolyData(np.column_stack([x, np.zeros_like(x), z]))
    cloud["velocity"] = np.column_stack([vx, np.zeros_like(vx), vz])
    return cloud


def densities(grid: Grid, moments_s: np.ndarray, shares: np.ndarray) -> pyvista.ImageData:
    """Shares of the batch in the cells of columns and rows, an array a moment [1]."""
    flat = grid.shown
    size = (flat.cell_width_m, flat.cell_width_m, flat.cell_height_m)
    image = pyvista.ImageData(dimensions=(grid.columns + 1, 2, grid.rows + 1), spacing=size)
    for moment, share in zip(moments_s, grid.projected(shares), strict=True):
        image.cell_data[f"share_{moment:g}_s"] = share
    return image


def write_dump(target: Path, values: np.ndarray, described: dict) -> None:
    """All frames as one LAMMPS text dump: id, x, y, z, vx, vy, vz."""
    box = f"0 {described['width_m']:g}\n-0.001 0.001\n0 {described['height_m']:g}\n"
    with atomic_file(target) as temporary, temporary.open("w", encoding="utf-8") as stream:
        for step, frame in zip(described["steps"], values, strict=True):
            x, z, vx, vz = np.asarray(frame[:4], float)
            table = np.column_stack([np.arange(1, len(x) + 1), x, 0 * x, z, vx, 0 * x, vz])
            stream.write(
                f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(x)}\nITEM: BOX BOUNDS ff ff ff\n{box}"
            )
            stream.write("ITEM: ATOMS id x y z vx vy vz\n")
            np.savetxt(stream, table, fmt="%d" + " %.6g" * 6)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", help="name of the case")
    case = parser.parse_args().case
    with report_user_errors():
        require_particles(case)
        print(export_bed(Path("results") / case))


if __name__ == "__main__":
    main()
