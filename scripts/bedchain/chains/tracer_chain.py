# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of the models that move tracers and keep their positions; they have no transition matrix.

The expected values of `chain.Chain` are, for these models, means over runs of tracers with a fixed seed. They
are repeatable, and differ from the expectation by the sampling error of so many tracers and paths.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bedchain.measures import mixing
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

# Seed of the runs for expected values.
SEED = 62015
# Tracers for expected mixing curves: a share of half of them has a standard error of 0.003.
EXPECTED_TRACERS = 50_000
# Time for a bed to forget its start, and time over which the density is averaged after it.
LONG_RUN_S = 20.0
# Approximate number of tracers for the long-run density: every k-th particle.
LONG_RUN_TRACERS = 10_000

Place = tuple[NDArray[np.float64], NDArray[np.float64]]


class TracerChain(ABC):
    """Model that keeps the positions of tracers; each subclass moves them by its `walk`.

    Attributes
    ----------
    expected_paths : int
        Runs averaged for expected values. 1 where tracers are independent: particles are then copied until
        there are `EXPECTED_TRACERS`.

    Parameters
    ----------
    name : str
        Name of the model.
    grid : Grid
        Cells of the densities and paths.
    lag : int
        Frames in a step.
    lag_s : float
        The same [s].
    report : dict of str to float
        Numbers about the learning.
    """

    expected_paths = 1

    def __init__(self, name: str, grid: Grid, lag: int, lag_s: float, report: dict[str, float]) -> None:
        self.name, self.grid, self.lag, self.lag_s, self.report = name, grid, lag, lag_s, report

    @abstractmethod
    def walk(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[Place]:
        """Positions x, z [m] of every particle at steps 0 to ``steps``; the same arrays each time."""

    def mixing(
        self,
        start: Frames,
        split_x_m: float,
        split_z_m: float,
        steps: int,
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64]:
        """See `chain.Chain.mixing`; the side of a tracer follows from its position at every step."""
        mixing.side_shares(self.grid, split_x_m, split_z_m)  # refuses lines outside the bed
        generators = [rng] if rng is not None else self._expected()
        if rng is None:
            n = start.cells.shape[1]
            tracers = EXPECTED_TRACERS // self.expected_paths
            start = _chosen(start, self._copies(n) if n < tracers else np.arange(0, n, n // tracers))
        marked = mixing.sides(np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1]), split_x_m, split_z_m)
        size = marked.sum(axis=1)
        still = np.zeros((steps + 1, 4))
        for generator in generators:
            for step, (x, z) in enumerate(self.walk(start, steps, generator)):
                still[step] += _still(x, z, marked, split_x_m, split_z_m)
        curves = np.divide(
            still, len(generators) * size, out=np.full(still.shape, np.nan), where=(size > 0)[None]
        )
        curves[0] = np.where(size > 0, 1.0, np.nan)
        return np.asarray(curves)

    def densities(
        self,
        start: Frames,
        marked: NDArray[np.bool_],
        steps: Sequence[int],
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64] | NDArray[np.int64]:
        """See `chain.Chain.densities`."""
        step_numbers = np.asarray(steps, np.int64)
        n = marked.shape[1]
        total = np.zeros((len(steps), len(marked), self.grid.n_cells), np.int64)
        generators = [rng] if rng is not None else self._expected()
        if rng is None:
            copies = self._copies(start.cells.shape[1])
            start, marked = _chosen(start, copies), marked[:, copies]
        for generator in generators:
            for step, cells in enumerate(self.paths(start, int(step_numbers.max()), generator)):
                if (places := step_numbers == step).any():
                    total[places] += mixing.marked_histogram(cells, marked, self.grid.n_cells)
        return total if rng is not None else total / (len(generators) * marked.shape[1] / n)

    def paths(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[NDArray[np.int32]]:
        """See `chain.Chain.paths`."""
        for x, z in self.walk(start, steps, rng):
            yield self.grid.cell_of(x, z)

    def long_run_density(self, start: Frames) -> NDArray[np.float64]:
        """See `chain.Chain.long_run_density`; mean over the steps of a long run of some of the particles."""
        n = start.cells.shape[1]
        some = _chosen(start, np.arange(0, n, max(1, n // LONG_RUN_TRACERS)))
        steps = max(int(np.ceil(LONG_RUN_S / self.lag_s)), 1)
        held = np.zeros(self.grid.n_cells)
        for step, cells in enumerate(self.paths(some, 2 * steps, np.random.default_rng(SEED))):
            if step > steps:
                held += np.bincount(cells, minlength=self.grid.n_cells)
        return np.asarray(held / held.sum())

    def _expected(self) -> list[np.random.Generator]:
        return np.random.default_rng(SEED).spawn(self.expected_paths)

    def _copies(self, n_particles: int) -> NDArray[np.int64]:
        """Numbers of the particles, repeated until there are `EXPECTED_TRACERS` (independent tracers)."""
        copies = 1 if self.expected_paths > 1 else -(-EXPECTED_TRACERS // n_particles)
        return np.tile(np.arange(n_particles), copies)


def start_places(start: Frames, grid: Grid) -> Place:
    """Positions in the last frame, in float64 and inside the bed [m].

    Raises
    ------
    DataError
        A particle is outside the bed.
    """
    x, z = np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1])
    grid.cell_of(x, z)
    # A position at a wall may be slightly outside in float32.
    return np.minimum(x.astype(np.float64), grid.width_m), np.minimum(z.astype(np.float64), grid.height_m)


def reflect(place: NDArray[np.float64], top: float) -> None:
    """Mirror positions back into 0 to ``top``, in place, as often as needed."""
    np.abs(place, out=place)
    over = place > top
    if over.any():
        folded = np.mod(place[over], 2 * top)
        place[over] = np.minimum(folded, 2 * top - folded)


@njit(cache=True)
def _still(x, z, marked, split_x_m, split_z_m):  # type: ignore[no-untyped-def]
    """Particles of each group that are on its side, (4,)."""
    total = np.zeros(4)
    for p in range(x.size):
        left, low = x[p] < split_x_m, z[p] < split_z_m
        total[0] += marked[0, p] and left
        total[1] += marked[1, p] and not left
        total[2] += marked[2, p] and low
        total[3] += marked[3, p] and not low
    return total


def _chosen(frames: Frames, particles: NDArray[np.int64]) -> Frames:
    """The last two frames of the given particles, in their order."""
    last = frames.part(slice(max(0, len(frames.times_s) - 2), None))
    x, z, cells = np.asarray(last.x_m), np.asarray(last.z_m), np.asarray(last.cells)
    vx, vz = (None if v is None else np.asarray(v)[:, particles] for v in (last.vx_m_s, last.vz_m_s))
    return Frames(last.times_s, x[:, particles], z[:, particles], cells[:, particles], vx, vz)
