# SPDX-License-Identifier: GPL-3.0-or-later
"""Markov chain on a set of states, each of which lies in one cell."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import propagate
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.chains.velocity_binning import VelocityClasses
from bedchain.errors import DataError
from bedchain.measures import mixing
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import OUTSIDE, Grid

# what a file of a chain says of its grid beside bed_m and grid
DEEP = ("depth_m", "layers", "form", "axis")


@dataclass(frozen=True)
class MarkovChain:
    """Transition matrix between states, the cell of each state, and the rule for a particle's state.

    The state of a particle follows from its symbols in the last ``history`` frames before the start, one lag
    apart: oldest first, they are the digits of its key, a number in base ``n_symbols``. The symbol is the
    cell or, with velocity classes, cell * classes + class. A particle whose key is no state's has the state
    ``fallback + cell``.

    Parameters
    ----------
    name : str
        Name of the model.
    grid : Grid
        The cells.
    lag : int
        Frames in a step.
    lag_s : float
        The same [s].
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    cell_of_state : (n_states,) int32 array
        Cell that each state lies in.
    history : int
        Frames, one lag apart, that determine a state.
    state_keys : (n_keyed,) int64 array
        Rising keys of the first ``n_keyed`` states.
    fallback : int
        First of the ``n_cells`` states for particles with an unknown key.
    report : dict of str to float
        Numbers about the learning.
    classes : VelocityClasses, optional
        Classes of the velocity, if they are part of the states.
    """

    name: str
    grid: Grid
    lag: int
    lag_s: float
    matrix: sparse.csr_array
    cell_of_state: NDArray[np.int32]
    history: int
    state_keys: NDArray[np.int64]
    fallback: int
    report: dict[str, float] = field(default_factory=dict)
    classes: VelocityClasses | None = None

    @property
    def n_symbols(self) -> int:
        """Number of symbols that a particle may have in a frame [1]."""
        return self.grid.n_cells * (1 if self.classes is None else self.classes.number)

    def symbols(self, frames: Frames) -> NDArray[np.int32]:
        """Symbol of each particle in each frame from number ``back`` on, (n_frames - back, n_particles)."""
        cells = np.asarray(frames.cells)
        if self.classes is None:
            return cells
        symbols = cells[self.back :] * np.int32(self.classes.number) + self.classes.of(frames)
        return np.maximum(symbols, np.int32(OUTSIDE))  # of particles that are not there

    @property
    def back(self) -> int:
        """Earlier frames that the symbols of a frame need [1]."""
        return 0 if self.classes is None else self.classes.back

    def states(self, start: Frames) -> NDArray[np.int32]:
        """State of each particle in the last frame, (n_particles,).

        Raises
        ------
        DataError
            There are fewer frames than a state needs.
        """
        span = (self.history - 1) * self.lag + 1
        needed = span + self.back
        if len(start.times_s) < needed:
            raise DataError(
                f"the {self.name} chain starts from {needed} frames, {len(start.times_s)} given: "
                "start later, so that there are as many frames before the start"
            )
        # One frame more, if there is one: differences of positions replace velocities that were not measured.
        first = max(0, len(start.times_s) - needed - 1)
        return self.states_of(self.symbols(start.part(slice(first, None)))[-span :: self.lag])

    def states_of(self, symbols: NDArray[np.int32]) -> NDArray[np.int32]:
        """State of each particle from its symbols, (history, n_particles), oldest first; (n_particles,)."""
        keys = np.zeros(symbols.shape[1], np.int64)
        for now in symbols:
            keys = keys * self.n_symbols + now
        unknown = self.fallback + symbols[-1] // np.int32(self.n_symbols // self.grid.n_cells)
        if self.state_keys.size == 0:
            return unknown.astype(np.int32)
        place = np.minimum(np.searchsorted(self.state_keys, keys), self.state_keys.size - 1)
        return np.where(self.state_keys[place] == keys, place, unknown).astype(np.int32)

    def places_of(self, other: "MarkovChain") -> NDArray[np.int64]:
        """State of this chain for each state of one learned from a part of the same window, (n_states,)."""
        keyed = np.searchsorted(self.state_keys, other.state_keys)
        n_rest = other.matrix.shape[0] - other.state_keys.size
        return np.concatenate((keyed, self.fallback + np.arange(n_rest)))

    def mixing(
        self,
        start: Frames,
        split_x_m: float,
        split_z_m: float,
        steps: int,
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64]:
        """See `chain.Chain.mixing`; after step 0 a cell cut by a line counts for both sides, by area."""
        marked = mixing.sides(np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1]), split_x_m, split_z_m)
        shares = mixing.side_shares(self.grid, split_x_m, split_z_m)
        if rng is None:
            begin = mixing.marked_histogram(self.states(start), marked, self.matrix.shape[0]).astype(float)
            # Left and right are complements, as are low and up: two observables give all four curves.
            means = propagate.expected_values(
                self.matrix, begin, shares[[0, 2]][:, self.cell_of_state], steps
            )
            curves = np.stack(
                (means[:, 0, 0], 1 - means[:, 1, 0], means[:, 2, 1], 1 - means[:, 3, 1]), axis=1
            )
        else:
            curves = np.concatenate(
                [
                    mixing.remaining_from_cells(cells[None], marked, shares)
                    for cells in self.paths(start, steps, rng)
                ]
            )
        curves[0] = np.where(marked.any(axis=1), 1.0, np.nan)
        return curves

    def densities(
        self,
        start: Frames,
        marked: NDArray[np.bool_],
        steps: Sequence[int],
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64] | NDArray[np.int64]:
        """See `chain.Chain.densities`."""
        if rng is not None:
            step_numbers = {int(step) for step in steps}
            counts = {
                step: mixing.marked_histogram(cells, marked, self.grid.n_cells)
                for step, cells in enumerate(self.paths(start, max(step_numbers), rng))
                if step in step_numbers
            }
            return np.stack([counts[int(step)] for step in steps])
        begin = mixing.marked_histogram(self.states(start), marked, self.matrix.shape[0]).astype(float)
        return np.stack(
            [self._in_cells(by_state) for by_state in propagate.propagate(self.matrix, begin, steps)]
        )

    def paths(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[NDArray[np.int32]]:
        """See `chain.Chain.paths`."""
        for states in propagate.walk(self.matrix, self.states(start), steps, rng):
            yield self.cell_of_state[states]

    def long_run_density(self, start: Frames) -> NDArray[np.float64]:
        """See `chain.Chain.long_run_density`."""
        begin = np.bincount(self.states(start), minlength=self.matrix.shape[0]).astype(float)
        return self._in_cells(long_run_density(self.matrix, begin))

    def _in_cells(self, by_state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sums over the states of each cell: (..., n_states) to (..., n_cells)."""
        n_states = self.cell_of_state.size
        index = (self.cell_of_state, np.arange(n_states + 1))
        return np.asarray(
            by_state @ sparse.csr_array((np.ones(n_states), *index), shape=(n_states, self.grid.n_cells))
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """See `chain.Chain.arrays`."""
        grid, classes = self.grid, self.classes
        edges = {} if classes is None else classes.arrays()
        return edges | {
            "bed_m": np.array([grid.width_m, grid.height_m]),
            "grid": np.array([grid.columns, grid.rows]),
            **{name: np.array(value) for name, value in grid.arrays().items() if name in DEEP},
            "step": np.array([self.lag, self.history, self.fallback]),
            "lag_s": np.array(self.lag_s),
            "data": self.matrix.data,
            "indices": self.matrix.indices,
            "indptr": self.matrix.indptr,
            "cell_of_state": self.cell_of_state,
            "state_keys": self.state_keys,
            "report": np.array(json.dumps(self.report)),
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "MarkovChain":
        """Chain from the arrays of `arrays`.

        Raises
        ------
        DataError
            An array is missing.
        """
        try:
            flat = dict(
                zip(
                    ("width_m", "height_m", "columns", "rows"),
                    (*arrays["bed_m"], *arrays["grid"]),
                    strict=True,
                )
            )
            lag, history, fallback = (int(number) for number in arrays["step"])
            n_states = arrays["indptr"].size - 1
            classes = VelocityClasses.from_arrays(arrays) if "edges_x" in arrays else None
            matrix = sparse.csr_array(
                (arrays["data"], arrays["indices"], arrays["indptr"]), shape=(n_states, n_states)
            )
            matrix.check_format(full_check=True)  # compiled loops trust its indices
            fits = arrays["cell_of_state"].shape == (n_states,) and np.isfinite(matrix.data).all()
            if not fits or matrix.data.min(initial=0) < 0:
                raise DataError("the matrix of a chain does not fit its states")
            return cls(
                str(arrays["name"]),
                Grid.from_arrays(arrays | flat),
                lag,
                float(arrays["lag_s"]),
                matrix,
                arrays["cell_of_state"],
                history,
                arrays["state_keys"],
                fallback,
                json.loads(str(arrays["report"])),
                classes,
            )
        except KeyError as error:
            raise DataError(f"the file of a chain lacks {error}: build the transitions again") from error
