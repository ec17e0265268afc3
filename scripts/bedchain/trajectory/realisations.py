# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of one bed, the one learned from and its repeats: their frames on any grid of cells."""

import logging
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.trajectory.frames import TIME_TOLERANCE, Frames, check_times, window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import open_trajectory

LOG = logging.getLogger(__name__)

# how far back a chain may look at most, in frames of the run that a repeat branches off from
PAST_FRAMES = 64
# positions of one state written twice differ by less, over the width of the bed
SAME_PLACE = 1e-6


@dataclass(frozen=True)
class Run:
    """One simulated bed on disk.

    Parameters
    ----------
    name : str
        For messages.
    values : (n_frames, 4, n_particles) array
        Rows x, z [m], vx, vz [m/s]; a memory map.
    times_s : (n_frames,) array
        [s].
    width_m, height_m : float
        Size of the bed [m].
    has_velocities : bool
        Whether the last two rows hold numbers.
    past : (n_past, 4, n_particles) array, optional
        What came before the first frame, where another run holds it.
    """

    name: str
    values: NDArray[np.floating]
    times_s: NDArray[np.float64]
    width_m: float
    height_m: float
    has_velocities: bool = True
    past: NDArray[np.floating] | None = None

    @property
    def interval_s(self) -> float:
        """Time between two frames [s]."""
        return float(self.times_s[-1] - self.times_s[0]) / max(len(self.times_s) - 1, 1)

    def frames(self, grid: Grid, which: slice) -> Frames:
        """Frames of a slice, with their cells on a grid.

        Parameters
        ----------
        grid : Grid
        which : slice
            Of the run's frames, both ends given.

        Returns
        -------
        Frames
            Without velocities where the run has none: models take differences of positions then.
        """
        return self._made(grid, self.values[which], self.times_s[which], which.start)

    def leading_to(self, grid: Grid, frame: int, before: int) -> Frames:
        """A frame and those before it that a chain may look back to, as far as there are any.

        Parameters
        ----------
        grid : Grid
        frame : int
            The last frame given.
        before : int
            Frames wanted before it [1].

        Returns
        -------
        Frames
        """
        values, first = self.values[max(0, frame - before) : frame + 1], max(0, frame - before)
        lacking = before - frame
        if lacking > 0 and self.past is not None:
            values = np.concatenate((self.past[-lacking:], values))
            first = frame + 1 - len(values)
        times = self.times_s[0] + self.interval_s * np.arange(first, frame + 1)
        return self._made(grid, values, times, first)

    def _made(
        self, grid: Grid, values: NDArray[np.floating], times_s: NDArray[np.float64], first: int
    ) -> Frames:
        cells = np.stack([grid.cell_of(now[0], now[1], frame) for frame, now in enumerate(values, first)])
        vx, vz = (values[:, 2], values[:, 3]) if self.has_velocities else (None, None)
        return Frames(times_s, values[:, 0], values[:, 1], cells, vx, vz)


def open_run(name: str, trajectory: Path, metadata: Path) -> Run:
    """Open a run's trajectory and check its times.

    Parameters
    ----------
    name : str
        For messages.
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json``.

    Returns
    -------
    Run

    Raises
    ------
    UserError
        The two files do not fit each other, or frames are missing or out of order.
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
    return Run(name, values, times, float(about["width_m"]), float(about["height_m"]), has)


def open_repeats(paths: list[Path], main: Run) -> list[Run]:
    """Open repeats of a run, and refuse what is no repeat of it.

    Parameters
    ----------
    paths : list of Path
        ``repeats/<N>/trajectory.npy``, each with its ``trajectory.json``.
    main : Run
        The run that they repeat.

    Returns
    -------
    list of Run

    Raises
    ------
    UserError
        Another number of particles, size of the bed or frame interval.
    """
    runs = [open_run(f"repeat {path.parent.name}", path, path.with_suffix(".json")) for path in paths]
    for run, path in zip(runs, paths, strict=True):
        pairs = {
            "particles": (run.values.shape[2], main.values.shape[2]),
            "metres of width": (run.width_m, main.width_m),
            "metres of height": (run.height_m, main.height_m),
            "seconds between frames": (run.interval_s, main.interval_s),
        }
        for what, (found, wanted) in pairs.items():
            if abs(found - wanted) > TIME_TOLERANCE * wanted:
                raise UserError(
                    f"{path} is no repeat of the bed: {found:g} {what}, {wanted:g} expected; "
                    "remove its folder or simulate it with the case's numbers"
                )
    return [_with_past(run, main) for run in runs]


def _with_past(run: Run, main: Run) -> Run:
    """A repeat that branches off from a frame of the main run, with what came before in that run."""
    frame = round((run.times_s[0] - main.times_s[0]) / main.interval_s)
    if not 0 < frame < len(main.times_s):
        return run
    apart = np.abs(run.values[0, :2] - main.values[frame, :2]).max()
    if apart > SAME_PLACE * run.width_m:
        return run
    return replace(run, past=main.values[max(0, frame - PAST_FRAMES) : frame])


def part_of(run: Run, start_s: float, end_s: float) -> slice:
    """Frames of a window, cut where the run ends early.

    Parameters
    ----------
    run : Run
    start_s, end_s : float
        The window, both ends included [s].

    Returns
    -------
    slice

    Raises
    ------
    UserError
        Less than half of the window is there, or an end is not the time of a frame.
    """
    last_s = float(run.times_s[-1])
    if last_s >= end_s - TIME_TOLERANCE * run.interval_s:
        return window(run.times_s, start_s, end_s)
    share = max(0.0, (last_s - start_s) / (end_s - start_s))
    if share < 0.5:
        raise UserError(
            f"{run.name} lacks frames: it ends at {last_s:g} s and holds {share:.0%} of the window from "
            f"{start_s:g} s to {end_s:g} s, at least half is needed; simulate it further or remove its folder"
        )
    LOG.info("%s ends at %g s: %.0f %% of the window to %g s is used", run.name, last_s, 100 * share, end_s)
    return window(run.times_s, start_s, last_s)
