# SPDX-License-Identifier: GPL-3.0-or-later
"""Interface that every chain has."""

from collections.abc import Iterator, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid


class Chain(Protocol):
    """A learned model.

    Attributes
    ----------
    name : str
        Name of the model.
    grid : Grid
        Cells of the densities and paths.
    lag_s : float
        Time between two steps [s].
    report : dict of str to float
        Numbers about the learning, by ``<quantity>_<unit>``, for metrics.csv.
    """

    @property
    def name(self) -> str: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def lag_s(self) -> float: ...
    @property
    def report(self) -> dict[str, float]: ...

    def mixing(
        self,
        start: Frames,
        split_x_m: float,
        split_z_m: float,
        steps: int,
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64]:
        """Share of each group of `mixing.GROUPS`, marked in the last frame of ``start``, still on its side.

        Expected values, or with an ``rng`` a Monte Carlo run of every particle; (steps + 1, 4), 1 at step 0.
        """
        ...

    def densities(
        self,
        start: Frames,
        marked: NDArray[np.bool_],
        steps: Sequence[int],
        rng: np.random.Generator | None = None,
    ) -> NDArray[np.float64] | NDArray[np.int64]:
        """Particles of each marked group in each cell at rising steps, (n_steps, n_groups, n_cells).

        Expected numbers, or with an ``rng`` the int64 counts of a Monte Carlo run of every particle.
        """
        ...

    def paths(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[NDArray[np.int32]]:
        """Cell of every particle at steps 0 to ``steps``, one after the other."""
        ...

    def long_run_density(self, start: Frames) -> NDArray[np.float64]:
        """Share of the particles in each cell in the long run, (n_cells,), sum 1."""
        ...

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The chain as plain arrays, for `registry.load`."""
        ...
