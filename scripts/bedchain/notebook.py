# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed from plain arrays, for a notebook: its chain, mixing curves, residence times, each with a band."""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.open_chain import OpenChain, open_chain
from bedchain.chains.passage import residence_in_cells
from bedchain.errors import DataError
from bedchain.files import write_csv
from bedchain.measures.mixing import GROUPS, remaining_from_positions
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.uncertainty.bands import block_band, correlation_times, kept_blocks, kept_steps


@dataclass(frozen=True)
class Bed:
    """Frames of particles on a grid of cells; make it by `from_arrays`.

    Parameters
    ----------
    run : Realisation
        The frames, from the corner of the bed.
    grid : Grid
    """

    run: Realisation
    grid: Grid

    @classmethod
    def from_arrays(
        cls, positions_m: ArrayLike, times_s: ArrayLike, cells: Sequence[int],
        box_m: Sequence[Sequence[float]] | None = None, *, form: str = "boxes", may_leave: bool = False,
    ) -> "Bed":  # fmt: skip
        """A bed from positions.

        Parameters
        ----------
        positions_m : (n_frames, n_particles, 2 or 3) array
            x and z, or x, y and z (z upwards) [m]; NaN where a particle is not there.
        times_s : (n_frames,) array
            Evenly spaced [s].
        cells : sequence of int
            Columns and rows and, in three dimensions, layers [1].
        box_m : sequence of (low, high), optional
            Bounds along each axis [m]; by default of all positions.
        form : {"boxes", "rings", "sectors"}
            Of the cells, see `bedchain.trajectory.grid.Grid`.
        may_leave : bool
            Whether particles outside the box have left, instead of being an error.

        Raises
        ------
        DataError
            Shapes do not fit, times are uneven, or a particle is outside the box.
        """
        positions, times = np.asarray(positions_m, float), np.asarray(times_s, float)
        if positions.ndim != 3 or positions.shape[2] not in (2, 3) or times.shape != positions.shape[:1]:
            raise DataError(
                f"positions of shape {positions.shape} at times of shape {times.shape}: (n_frames, "
                "n_particles, "
                "2 or 3) and (n_frames,) expected"
            )
        box = np.asarray(box_m if box_m is not None else _bounds(positions), float)
        if box.shape != (positions.shape[2], 2) or not (box[:, 1] >= box[:, 0]).all():
            raise DataError(
                f"box_m of shape {box.shape}: (low, high) for each of {positions.shape[2]} axes expected"
            )
        values = np.full((len(positions), 4 + (positions.shape[2] == 3), positions.shape[1]), np.nan)
        rows = (0, 4, 1) if positions.shape[2] == 3 else (0, 1)
        for axis, row in enumerate(rows):
            values[:, row] = positions[:, :, axis] - box[axis, 0]
        gone = ~np.isfinite(positions).all(axis=2)
        if may_leave:
            gone |= ((positions < box[:, 0]) | (positions > box[:, 1])).any(axis=2)
        values = np.where(gone[:, None], np.nan, values)
        size = box[:, 1] - box[:, 0]
        run = Realisation(
            "the arrays", values, times, float(size[0]), float(size[-1]), has_velocities=False,
            y_row=4 if positions.shape[2] == 3 else None,
        )  # fmt: skip
        depth = float(size[1]) if positions.shape[2] == 3 else 0.0
        grid = Grid(run.width_m, run.height_m, cells[0], cells[1], depth, *cells[2:3], form=form)
        return cls(run, grid)

    def chain(
        self, start_s: float, end_s: float, lag_s: float | None = None, model: str = "static"
    ) -> MarkovChain | Chain:
        """A chain learned from a window.

        Parameters
        ----------
        start_s, end_s : float
            Ends of the window [s].
        lag_s : float, optional
            Length of a step [s], by default the time between frames.
        model : str
            A name of `bedchain.chains.registry.LEARNERS`.
        """
        frames = self.run.frames(self.grid, Window(start_s, end_s).frames(self.run.times_s))
        return registry.learn(model, frames, self.grid, self._lag(lag_s))

    def mixing(
        self, chain: Chain, learned: tuple[float, float], compared: tuple[float, float],
        splits_m: tuple[float, float] | None = None,
    ) -> pd.DataFrame:  # fmt: skip
        """Mixing curves of the frames and of a chain, with the chain's 95 % band.

        Parameters
        ----------
        chain : Chain
            Of `chain`.
        learned : (float, float)
            The window that it was learned from, whose blocks give the band [s].
        compared : (float, float)
            Start, where particles are marked, and end [s].
        splits_m : (float, float), optional
            Lines between left and right, and between low and up, from the corner of the box [m]; by default
            through its middle.

        Returns
        -------
        DataFrame
            time_s, group (left, right, low, up), frames_1, chain_1, low_1, high_1; the last two are the 95 %
            band, NaN where the learning window is too short for one.
        """
        splits = splits_m or (self.run.width_m / 2, self.run.height_m / 2)
        lag, which = self._lag(chain.lag_s), Window(*compared).frames(self.run.times_s)
        start = self.run.leading_to(self.grid, which.start, lag)
        steps = (which.stop - 1 - which.start) // lag
        frames = self.run.frames(self.grid, Window(*learned).frames(self.run.times_s))

        def curves_of(some: Chain) -> NDArray[np.float64]:
            return some.mixing(start, *splits, steps)

        learn = registry.relearner(chain.name, frames, self.grid, lag)
        value, times_held = curves_of(chain), correlation_times(frames, splits[0], lag)
        left_out = np.stack([curves_of(learn(kept)) for kept in kept_blocks()])
        low, high = block_band(value, left_out, "share", times_held)
        seen = self.run.values[which][::lag][: steps + 1]
        curves = (
            remaining_from_positions(seen[:, 0], seen[:, 1], *splits),
            value,
        )
        times = self.run.times_s[which][::lag][: steps + 1]
        return pd.concat(
            pd.DataFrame(
                {
                    "time_s": times,
                    "group": group,
                    "frames_1": curves[0][:, at],
                    "chain_1": curves[1][:, at],
                    "low_1": low[:, at], "high_1": high[:, at],
                }
            )
            for at, (_, group) in enumerate(GROUPS)
        )  # fmt: skip

    def residence_s(
        self, start_s: float, end_s: float, lag_s: float | None = None
    ) -> tuple[float, float, float]:
        """Mean residence time of an open bed by its chain, and the ends of its 95 % band [s].

        Parameters
        ----------
        start_s, end_s : float
            Window in which particles come and go [s].
        lag_s : float, optional
            Length of a step [s], by default the time between frames.

        Raises
        ------
        DataError
            No particle entered or left.
        """
        lag = self._lag(lag_s)
        frames = self.run.frames(self.grid, Window(start_s, end_s).frames(self.run.times_s))
        steps = len(frames.times_s) - lag

        def chain_of(weights: NDArray[np.int64] | None = None) -> OpenChain:
            counts = count_moves(frames.cells, self.grid.n_cells, lag, step_weights=weights)
            return open_chain([counts], lag * self.run.interval_s)

        time_s = chain_of().residence()[0]
        left_out = [chain_of(kept_steps(kept, steps)).residence()[0] for kept in kept_blocks()]
        low, high = block_band(time_s, np.array(left_out), "positive")
        return time_s, float(low), float(high)

    def _lag(self, lag_s: float | None) -> int:
        return 1 if lag_s is None else lag_frames(lag_s, self.run.interval_s)


def _bounds(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack((np.nanmin(positions, axis=(0, 1)), np.nanmax(positions, axis=(0, 1))))


def residence_in_cells_s(chain: MarkovChain) -> NDArray[np.float64]:
    """Mean time in each cell from entering to leaving it, in the long run, (n_cells,) [s]."""
    n_states = chain.matrix.shape[0]
    return residence_in_cells(chain, np.full(n_states, 1 / n_states))[0]


def write_chain(chain: MarkovChain, target: Path | str) -> None:
    """Write a chain's matrix as csv: from_state, to_state, probability_1, from_cell, to_cell."""
    entries = chain.matrix.tocoo()
    origin, goal = entries.coords
    table = pd.DataFrame({"from_state": origin, "to_state": goal, "probability_1": entries.data})
    table["from_cell"], table["to_cell"] = chain.cell_of_state[origin], chain.cell_of_state[goal]
    write_csv(table, Path(target))


def to_deeptime(chain: MarkovChain) -> Any:
    """The chain as a ``deeptime.markov.msm.MarkovStateModel`` over its states.

    Raises
    ------
    DataError
        deeptime is not installed.
    """
    try:
        model = importlib.import_module("deeptime.markov.msm").MarkovStateModel
    except ImportError as error:
        raise DataError(f"deeptime is not installed ({error}): pip install deeptime") from error
    return model(chain.matrix.toarray(), lagtime=chain.lag)
