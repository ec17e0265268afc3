# SPDX-License-Identifier: GPL-3.0-or-later
"""Picture of a bed while it is simulated: newest frame, voidage, series so far; results/<case>/look.png.

usage: ./run look [CASE]

Reads what the run has written, also in the segment that it is at, and writes nothing but the picture.
"""

import argparse
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.case.particle_free import require_particles
from bedchain.dem.gas_field import GasField, read_gas_field
from bedchain.dem.segments import frame_columns, read_parameters
from bedchain.errors import UserError, report_user_errors
from bedchain.figures.style import DOUBLE_COLUMN_IN, MOST_SLENDER, close_frame, figure_style
from bedchain.files import atomic_file
from bedchain.trajectory.dumps import read_dump

SERIES = {
    "pressure_drop_Pa": "pressure drop [Pa]",
    "surface_angle_rad": "inclination of the surface [rad]",
    "mean_height_m": "mean particle height [m]",
}
FREEBOARD = 0.15
TALL_IN, DPI = 4.0, 130
# the newest frames may be half written: LIGGGHTS and the disk are at them
TRIED = 3


@dataclass(frozen=True)
class Newest:
    """What a run has written last.

    Attributes
    ----------
    time_s : float
        Of the frame [s].
    frame : Path
    x_m, z_m, vz_m_s : (n_particles,) ndarray
        [m], [m/s]
    gas : GasField or None
        At the end of the newest finished segment that has one.
    series : DataFrame
        ``bed_series.csv`` of all segments.
    """

    time_s: float
    frame: Path
    x_m: np.ndarray
    z_m: np.ndarray
    vz_m_s: np.ndarray
    gas: GasField | None
    series: pd.DataFrame


def look_at_bed(results: Path) -> Newest:
    """Draw the newest state of a bed.

    Parameters
    ----------
    results : Path
        ``results/<case>``; gets ``look.png``.

    Returns
    -------
    Newest
        What was drawn.

    Raises
    ------
    UserError
        Nothing is simulated yet.
    """
    state = newest_state(results)
    with figure_style():
        columns = 2 if state.gas is None else 3
        figure = plt.figure(figsize=(DOUBLE_COLUMN_IN, TALL_IN))
        grid = figure.add_gridspec(2, columns, width_ratios=[1] * (columns - 1) + [1.6])
        size = (state.x_m.max(), (1 + FREEBOARD) * state.z_m.max())
        _draw_particles(figure.add_subplot(grid[:, 0]), state, size)
        if state.gas is not None:
            _draw_gas(figure.add_subplot(grid[:, 1]), state.gas, size)
        shown = [name for name in SERIES if name in state.series][:2]
        for row, name in enumerate(shown):
            axes = figure.add_subplot(grid[row, -1])
            axes.plot(state.series["time_s"], state.series[name], lw=0.7, color="#222222")
            axes.set_title(SERIES[name], loc="left")
            axes.set_xlabel("time [s]" if row == len(shown) - 1 else "")
        with atomic_file(results / "look.png") as temporary:
            figure.savefig(temporary, dpi=DPI)
    return state


def newest_state(results: Path) -> Newest:
    """The newest whole frame of a run, with the gas and the series beside it."""
    parameters = read_parameters(results / "parameters.lig")
    runs = [folder for folder in (results / "dem").glob("*/") if [*folder.glob("segment_*")]]
    if not runs:
        raise UserError(f"{results}/dem: no segment yet; the particles settle first, then ./run look again")
    run = max(runs, key=lambda folder: folder.stat().st_mtime)
    segments = sorted(run.glob("segment_*"), key=lambda folder: folder.name.removesuffix(".part"))
    frames = {int(file.stem.split("_")[1]): file for part in segments for file in part.glob("frame_*")}
    for step in sorted(frames, reverse=True)[:TRIED]:
        try:
            dump = read_dump(frames[step], frame_columns(parameters))
        except UserError:
            continue
        x, z, vz = (dump.values[:, frame_columns(parameters).index(name)] for name in ("x", "z", "vz"))
        time_s = step * float(parameters["dem_step"])
        return Newest(time_s, frames[step], x, z, vz, newest_gas(segments), series_so_far(segments))
    raise UserError(f"{run}: no whole frame yet; try again in a moment")


def newest_gas(segments: list[Path]) -> GasField | None:
    """Voidage at the end of the newest finished segment; None in a bed without gas."""
    for folder in reversed(segments):
        if folder.suffix != ".part" and any((folder / "gas").glob("**/voidage")):
            return read_gas_field(folder / "gas", "voidage")
    return None


def series_so_far(segments: list[Path]) -> pd.DataFrame:
    """Series of all segments; of the running one, up to its last whole line."""
    tables = []
    for folder in segments:
        for file in (folder / "gas" / "bed_series.csv", folder / "bed_series.csv"):
            if file.exists():
                whole = file.read_text(encoding="utf-8").rpartition("\n")[0]
                tables.append(pd.read_csv(io.StringIO(whole + "\n")) if whole else pd.DataFrame())
    return pd.concat(tables) if tables else pd.DataFrame()


def _draw_particles(axes: Axes, state: Newest, size: tuple[float, float]) -> None:
    fast = max(float(np.quantile(np.abs(state.vz_m_s), 0.98)), 1e-9)
    points = axes.scatter(
        state.x_m, state.z_m, c=state.vz_m_s, s=0.6, cmap="coolwarm", vmin=-fast, vmax=fast, linewidths=0,
        rasterized=True,
    )  # fmt: skip
    axes.set_title(f"particles, {state.time_s:.3f} s", loc="left")
    _bed(axes, size)
    axes.set_ylabel("z [m]")
    axes.figure.colorbar(
        points, ax=axes, orientation="horizontal", label="vertical velocity [m/s]", aspect=14
    )


def _draw_gas(axes: Axes, gas: GasField, size: tuple[float, float]) -> None:
    cells = pd.DataFrame({"x": gas.x_m.round(6), "z": gas.z_m.round(6), "voidage": gas.values})
    table = cells.pivot_table(index="z", columns="x", values="voidage")  # the mean over a deep bed's layers
    marks = axes.pcolormesh(
        table.columns,
        table.index,
        table,
        cmap="Blues_r",
        vmin=0.35,
        vmax=1,
        shading="nearest",
        rasterized=True,
    )
    axes.set_title(f"gas, {gas.time_s:.3f} s", loc="left")
    _bed(axes, size)
    axes.figure.colorbar(marks, ax=axes, orientation="horizontal", label="voidage [1]", aspect=14)


def _bed(axes: Axes, size: tuple[float, float]) -> None:
    axes.set(
        xlim=(0, size[0]), ylim=(0, min(size[1], MOST_SLENDER * size[0])), aspect="equal", xlabel="x [m]"
    )
    axes.locator_params(axis="x", nbins=2)
    close_frame(axes)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", nargs="?", default="short", help="name of the case (default: short)")
    case = parser.parse_args().case
    results = Path("results") / case
    with report_user_errors():
        require_particles(case)
        state = look_at_bed(results)
        print(f"{results}/look.png: {len(state.x_m)} particles at {state.time_s:.4g} s, of {state.frame}")


if __name__ == "__main__":
    main()
