# SPDX-License-Identifier: GPL-3.0-or-later
"""The jump chain: particles keep their positions and draw displacements from the samples of their cell.

A step adds to a particle's position the displacement of a random particle of the learning window that started
a step in the same cell (and velocity class; the class after the step comes with the sample). Assumed: the
displacement does not depend on the position within the cell, and particles are independent. Walls reflect. A
class with too few samples in a cell draws from all samples of the cell, an empty cell from the nearest cell
with samples. All samples weigh the same with every estimator (pooled).

The first assumption fails at walls: particles rebound close to the wall, and their displacements are drawn
anywhere in its cell. In the long run the cells at a wall hold a tenth to a quarter less than in the bed.
"""

import json
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.spatial import KDTree

from bedchain.chains.counting import step_starts
from bedchain.chains.tracer_chain import Place, TracerChain, start_places
from bedchain.chains.velocity_binning import VelocityClasses, measured, quantile_classes
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

FEWEST_SAMPLES = 10


class JumpChain(TracerChain):
    """Displacements by state, a state being a cell times a class of the velocity.

    Parameters
    ----------
    grid, lag, lag_s, report
        As `tracer_chain.TracerChain`.
    classes : VelocityClasses
        A single class if the velocity is no part of the state.
    samples : (dx_m, dz_m, later)
        Displacements [m], float32, and the class after each, uint16, by rising state; (n_samples,).
    first : (n_states + 1,) int64 array
        First sample of each state.
    fewest_samples : int
        States with fewer samples draw from all samples of their cell [1].
    """

    def __init__(
        self,
        grid: Grid,
        lag: int,
        lag_s: float,
        report: dict[str, float],
        classes: VelocityClasses,
        samples: tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint16]],
        first: NDArray[np.int64],
        fewest_samples: int,
    ) -> None:
        super().__init__("jump", grid, lag, lag_s, report)
        self.classes, self.samples, self.first = classes, samples, first
        self.fewest_samples = fewest_samples
        self._draw_from = _draw_from(grid, classes.number, first, fewest_samples)

    def walk(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[Place]:
        """See `tracer_chain.TracerChain.walk`; one draw for each particle and step."""
        grid = self.grid
        x, z = start_places(start, grid)
        # Two frames: differences of positions replace velocities that were not measured.
        last = start.part(slice(max(0, len(start.times_s) - 2), None))
        now = self.classes.of(last)[-1] if self.classes.number > 1 else np.zeros(x.size, np.int32)
        size = np.array([grid.width_m, grid.height_m])
        yield x, z
        for _ in range(steps):
            _jump(
                x, z, now, *self._draw_from, *self.samples,
                self.classes.number, grid.columns, grid.rows, size, rng,
            )  # fmt: skip
            yield x, z

    def arrays(self) -> dict[str, NDArray[Any]]:
        """See `chain.Chain.arrays`."""
        grid = self.grid
        return self.classes.arrays() | {
            "bed_m": np.array([grid.width_m, grid.height_m]),
            "grid": np.array([grid.columns, grid.rows]),
            "step": np.array([self.lag, self.fewest_samples]),
            "lag_s": np.array(self.lag_s),
            "dx_m": self.samples[0],
            "dz_m": self.samples[1],
            "later": self.samples[2],
            "first": self.first,
            "report": np.array(json.dumps(self.report)),
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "JumpChain":
        """Chain from the arrays of `arrays`.

        Raises
        ------
        DataError
            An array is missing.
        """
        try:
            lag, fewest = (int(number) for number in arrays["step"])
            width, height = (float(size) for size in arrays["bed_m"])
            return cls(
                Grid(width, height, *map(int, arrays["grid"])),
                lag,
                float(arrays["lag_s"]),
                json.loads(str(arrays["report"])),
                VelocityClasses.from_arrays(arrays),
                (arrays["dx_m"], arrays["dz_m"], arrays["later"]),
                arrays["first"],
                fewest,
            )
        except KeyError as error:
            raise DataError(f"the file of a chain lacks {error}: build the transitions again") from error


def learn(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    classes: Sequence[int] = (1, 1),
    fewest_samples: int = FEWEST_SAMPLES,
) -> JumpChain:
    """Jump chain from a window of frames.

    Parameters
    ----------
    frames, grid, lag, estimator, step_weights
        As `registry.learn`; the estimator makes no difference.
    classes : (n_x, n_z)
        Classes of the velocity along x and z [1]; (1, 1) for none.
    fewest_samples : int
        Classes with fewer samples in a cell draw from all samples of the cell [1].

    Returns
    -------
    JumpChain
        Its report holds the share of the visited states that have too few samples, and that of their moves.
    """
    starts = np.repeat(*step_starts(frames.cells, lag, step_weights=step_weights))
    edges = quantile_classes(frames, classes)
    n, n_states = frames.cells.shape[1], grid.n_cells * edges.number
    class_of = edges.of(frames) if edges.number > 1 else np.zeros(frames.cells.shape, np.int32)
    first = np.zeros(n_states + 1, np.int64)
    for frame in starts:
        first[1:] += np.bincount(frames.cells[frame] * edges.number + class_of[frame], minlength=n_states)
    np.cumsum(first, out=first)
    jumps, free = np.empty((2, starts.size * n), np.float32), first[:-1].copy()
    later = np.empty(starts.size * n, np.uint16)
    for frame in starts:
        state = np.asarray(frames.cells[frame]) * edges.number + class_of[frame]
        dx, dz = (np.asarray(p[frame + lag]) - np.asarray(p[frame]) for p in (frames.x_m, frames.z_m))
        _fill(state, dx, dz, class_of[frame + lag], free, jumps[0], jumps[1], later)
    report = _report(first, grid, edges.number, fewest_samples)
    report["velocities_from_differences_1"] = float(edges.number > 1 and not measured(frames))
    samples = (jumps[0], jumps[1], later)
    return JumpChain(grid, lag, lag * frames.interval_s, report, edges, samples, first, fewest_samples)


def _report(first: NDArray[np.int64], grid: Grid, n_classes: int, fewest_samples: int) -> dict[str, float]:
    count = np.diff(first)
    visited, thin = count > 0, count < fewest_samples
    return {
        "states_1": float(visited.sum()),
        "thin_state_share_1": float((thin & visited).sum() / visited.sum()),
        "fallback_share_1": float(count[thin].sum() / count.sum()),
        "empty_cells_1": float((count.reshape(grid.n_cells, n_classes).sum(axis=1) == 0).sum()),
        "moves_1": float(count.sum()),
    }


def _draw_from(
    grid: Grid, n_classes: int, first: NDArray[np.int64], fewest_samples: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First sample and number of samples from which each state draws, (n_states,) each."""
    count = np.diff(first)
    of_cell = count.reshape(grid.n_cells, n_classes).sum(axis=1)
    filled = np.flatnonzero(of_cell)
    # An empty cell draws from the filled cell whose centre is nearest.
    donor = filled[KDTree(grid.centres_m[filled]).query(grid.centres_m)[1]].repeat(n_classes)
    whole = (count < fewest_samples) | (of_cell.repeat(n_classes) == 0)
    begin = np.where(whole, first[donor * n_classes], first[:-1])
    return begin, np.where(whole, of_cell[donor], count)


@njit(cache=True)
def _fill(state, dx, dz, later_class, free, to_x, to_z, later):  # type: ignore[no-untyped-def]
    """Store the moves of one step by their states; ``free`` is the next free sample of each state."""
    for p in range(state.size):
        slot = free[state[p]]
        free[state[p]] = slot + 1
        to_x[slot], to_z[slot], later[slot] = dx[p], dz[p], later_class[p]


@njit(cache=True)
def _jump(x, z, now, begin, count, dx, dz, later, n_classes, columns, rows, size, rng):  # type: ignore[no-untyped-def]
    """One step of every particle, in place."""
    for p in range(x.size):
        column = min(int(x[p] * (columns / size[0])), columns - 1)
        row = min(int(z[p] * (rows / size[1])), rows - 1)
        state = (row * columns + column) * n_classes + now[p]
        drawn = begin[state] + np.int64(rng.random() * count[state])
        x[p], z[p] = _folded(x[p] + dx[drawn], size[0]), _folded(z[p] + dz[drawn], size[1])
        now[p] = later[drawn]


@njit(cache=True)
def _folded(place, top):  # type: ignore[no-untyped-def]
    """Position mirrored back into 0 to top."""
    while place < 0.0 or place > top:
        place = -place if place < 0.0 else 2.0 * top - place
    return place
