# SPDX-License-Identifier: GPL-3.0-or-later
"""Realisations of a bed, the main run and its repeats, and their frames on any grid of cells."""

import logging
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError, UserError
from bedchain.trajectory.cell_store import CellStore, frame_at, open_cells
from bedchain.trajectory.frames import TIME_TOLERANCE, Frames, Window, check_times, window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import BedFiles, open_trajectory

LOG = logging.getLogger(__name__)

# lags before a start: no state of a model looks back further
HISTORY_LAGS = 4
# frames of the main run that a repeat has as its past
PAST_FRAMES = 64
# over the width of the bed: positions of the same state in two runs differ by less
SAME_PLACE = 1e-6


@dataclass(frozen=True)
class Realisation:
    """A simulated bed on disk.

    Parameters
    ----------
    name : str
        For messages.
    values : (n_frames, >= 4, n_particles) array
        Rows x, z [m], vx, vz [m/s], and perhaps y [m]; a memory map.
    times_s : (n_frames,) array
        Times of the frames [s].
    width_m, height_m : float
        Size of the bed [m].
    has_velocities : bool
        Whether the last two rows are velocities.
    past : (n_past, 4, n_particles) array, optional
        Frames before the first one, from the main run.
    stored : CellStore, optional
        Cells of all frames on the grid of the case.
    y_row : int, optional
        Row of y, where there is one.
    """

    name: str
    values: NDArray[np.floating]
    times_s: NDArray[np.float64]
    width_m: float
    height_m: float
    has_velocities: bool = True
    past: NDArray[np.floating] | None = None
    stored: CellStore | None = None
    y_row: int | None = None

    @property
    def interval_s(self) -> float:
        """Time between two frames [s]."""
        return float(self.times_s[-1] - self.times_s[0]) / max(len(self.times_s) - 1, 1)

    @property
    def case_cells(self) -> CellStore:
        """The stored cells.

        Raises
        ------
        DataError
            It was opened without them.
        """
        if self.stored is None:
            raise DataError(f"{self.name} was opened without its cells")
        return self.stored

    @property
    def grid(self) -> Grid:
        """Grid of the stored cells."""
        return self.case_cells.grid

    def window(self, window: Window) -> Frames:
        """Frames of a window, with the stored cells; memory maps."""
        return self.frames(self.grid, window.frames(self.times_s))

    def frames(self, grid: Grid, which: slice) -> Frames:
        """Frames of a slice, with their cells on a grid.

        Parameters
        ----------
        grid : Grid
        which : slice
            Of the realisation's frames, with both ends.

        Returns
        -------
        Frames
            Without velocities where the realisation has none; models then take differences of positions.
        """
        cells = self._cells(grid, self.values[which], which.start)
        return self._frames(self.times_s[which], self.values[which], cells)

    def leading_to(self, grid: Grid, frame: int, lag: int, lags: int = HISTORY_LAGS) -> Frames:
        """A frame and those before it that a chain may look back to, as far as they exist.

        Parameters
        ----------
        grid : Grid
        frame : int
            Last frame.
        lag : int
            Frames in a step of the chain.
        lags : int
            Steps before the frame.

        Returns
        -------
        Frames
        """
        before = lags * lag
        lacking = before - frame
        if lacking <= 0 or self.past is None:
            return self.frames(grid, slice(max(0, frame - before), frame + 1))
        values = np.concatenate((self.past[-lacking:], self.values[: frame + 1]))
        first = frame + 1 - len(values)
        times = self.times_s[0] + self.interval_s * np.arange(first, frame + 1)
        return self._frames(times, values, cells_of(grid, values, first, self.y_row))

    def up_to(self, time_s: float, lag: int, grid: Grid) -> Frames:
        """`leading_to` the frame at a time [s], of the particles that are in it."""
        return self.leading_to(grid, frame_at(self.times_s, time_s), lag).seen_last()

    def _cells(self, grid: Grid, values: NDArray[np.floating], first: int) -> NDArray[np.int32]:
        if self.stored is not None and grid == self.stored.grid:
            return self.stored.cells[first : first + len(values)]
        return cells_of(grid, values, first, self.y_row)

    def _frames(
        self, times_s: NDArray[np.float64], values: NDArray[np.floating], cells: NDArray[np.int32]
    ) -> Frames:
        vx, vz = (values[:, 2], values[:, 3]) if self.has_velocities else (None, None)
        y = None if self.y_row is None else values[:, self.y_row]
        return Frames(times_s, values[:, 0], values[:, 1], cells, vx, vz, y)


def cells_of(
    grid: Grid, values: NDArray[np.floating], first: int = 0, y_row: int | None = None
) -> NDArray[np.int32]:
    """Cells of all particles, in a loop over frames, which saves memory.

    Parameters
    ----------
    grid : Grid
    values : (n_frames, >= 2, n_particles) array
        Rows x, z [m], ...
    first : int
        Number of the first frame, for messages.
    y_row : int, optional
        Row of y, where there is one.

    Returns
    -------
    (n_frames, n_particles) int32 array
    """
    return np.stack(
        [
            grid.cells_seen(now[0], now[1], frame, None if y_row is None else now[y_row])
            if np.isnan(now[0]).any()
            else grid.cell_of(now[0], now[1], frame, None if y_row is None else now[y_row])
            for frame, now in enumerate(values, first)
        ]
    )


def open_realisation(name: str, trajectory: Path, metadata: Path, cells: Path | None = None) -> Realisation:
    """A realisation from its trajectory, with checked times.

    Parameters
    ----------
    name : str
        For messages.
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json``.
    cells : Path, optional
        ``cells.npz``, the cells on the grid of the case.

    Returns
    -------
    Realisation

    Raises
    ------
    UserError
        A file is missing, the files do not fit, or frames are missing or out of order.
    """
    if not metadata.exists():
        raise UserError(f"{name}: {metadata} is missing beside its trajectory; write both again")
    values, about = open_trajectory(trajectory, metadata)
    times = np.array(about["times_s"], float)
    try:
        check_times(times)
    except UserError as error:
        raise UserError(f"{name}, {trajectory}: {error}") from error
    has = {"vx", "vz"} <= set(about["columns"]) and bool(np.isfinite(values[[0, -1], 2:]).all())
    if not has:
        LOG.info("%s: no velocities in %s; differences of positions take their place", name, trajectory)
    stored = None if cells is None else open_cells(cells)
    if stored is not None and values.shape[::2] != stored.cells.shape:
        raise UserError(f"{trajectory} and {cells} differ in frames or particles: run assign_cells again")
    size = float(about["width_m"]), float(about["height_m"])
    y_row = about["columns"].index("y") if "y" in about["columns"] else None
    return Realisation(name, values, times, *size, has, stored=stored, y_row=y_row)


def open_bed(bed: BedFiles) -> Realisation:
    """`open_realisation` of the run of a case."""
    return open_realisation("the run", bed.trajectory, bed.metadata, bed.cells)


def open_repeats(paths: list[Path], main: Realisation) -> list[Realisation]:
    """Repeats of a run, each checked to be of the same bed.

    Parameters
    ----------
    paths : list of Path
        ``repeats/<N>/trajectory.npy``, each with its ``trajectory.json``.
    main : Realisation
        The run that was repeated.

    Returns
    -------
    list of Realisation

    Raises
    ------
    UserError
        A repeat has another number of particles, size of the bed or frame interval.
    """
    runs = [open_realisation(f"repeat {path.parent.name}", path, path.with_suffix(".json")) for path in paths]
    for run, path in zip(runs, paths, strict=True):
        pairs = {
            "particles": (run.values.shape[2], main.values.shape[2]),
            "metres of width": (run.width_m, main.width_m),
            "metres of height": (run.height_m, main.height_m),
            "seconds between frames": (run.interval_s, main.interval_s),
        }
        for quantity, (number, wanted) in pairs.items():
            if abs(number - wanted) > TIME_TOLERANCE * wanted:
                raise UserError(
                    f"{path} is no repeat of the bed: {number:g} {quantity}, {wanted:g} expected; "
                    "move its folder away, or simulate it with the case's numbers"
                )
    return [_with_past(run, main) for run in runs]


def _with_past(run: Realisation, main: Realisation) -> Realisation:
    """A repeat, with the frames of the main run before the frame that it branches off from."""
    frame = round((run.times_s[0] - main.times_s[0]) / main.interval_s)
    if not 0 < frame < len(main.times_s):
        return run
    distance = np.abs(run.values[0, :2] - main.values[frame, :2]).max()
    if distance > SAME_PLACE * run.width_m:
        return run
    return replace(run, past=main.values[max(0, frame - PAST_FRAMES) : frame])


def part_of(run: Realisation, start_s: float, end_s: float) -> slice:
    """Slice of a window, shorter where the run ends early.

    Parameters
    ----------
    run : Realisation
    start_s, end_s : float
        The window, both ends included [s].

    Returns
    -------
    slice

    Raises
    ------
    UserError
        The run holds less than half of the window, or an end is not the time of a frame.
    """
    last_s = float(run.times_s[-1])
    if last_s >= end_s - TIME_TOLERANCE * run.interval_s:
        return window(run.times_s, start_s, end_s)
    share = max(0.0, (last_s - start_s) / (end_s - start_s))
    if share < 0.5:
        raise UserError(
            f"{run.name} lacks frames: it ends at {last_s:g} s and holds {share:.0%} of the window from "
            f"{start_s:g} s to {end_s:g} s, at least half is needed; simulate it further or move it away"
        )
    LOG.info("%s ends at %g s: %.0f %% of the window to %g s is used", run.name, last_s, 100 * share, end_s)
    return window(run.times_s, start_s, last_s)
