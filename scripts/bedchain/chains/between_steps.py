# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain at any frame: whole steps, then the fraction of a step by a matrix learned at that shorter lag.

A long lag forgets velocities, and is coarse in time. Between two steps a straight line is wrong, since
particles leave a group fastest just after they are marked: at a lag of 1 s on the paper's bed it errs by
2.17 noise floors, where the whole steps have 1.22. The matrices of the shorter lags have 1.23. Fractions
before the steps, or a first step prolonged by the fraction, were tried: 1.22 and 1.21, but only the order
used here goes with every model, since it needs no more than the cells of its particles.

A last step prolonged by the fraction forgets the velocity once less. That helps where the lag is too short
(walkers of a memory of 0.2 s at a lag of 1 s: 0.0105 instead of 0.0156). At lags that are long enough beds
gain as much as they lose, 1.02, 1.11, 1.11, 1.75 and 1.13 spreads of the starts instead of 1.03, 1.09, 1.13,
1.70 and 1.18 (paper, short, mueller at 0.9 and 0.6 m/s, drum), for twice the matrices.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.counting_by_block import count_move_blocks
from bedchain.chains.estimators import transition_matrix
from bedchain.chains.fraction_shares import ShareFractions
from bedchain.measures.mixing import Splits, side_shares, sides
from bedchain.trajectory.frames import Frames

Array = NDArray[np.float64]
FRACTION = "fraction_{}_{}"
PARTS = ("data", "indices", "indptr")


@dataclass(frozen=True)
class Fractions:
    """Matrices between the cells for fractions of a step.

    Parameters
    ----------
    matrices : tuple of (n_cells, n_cells) csr_array
        For 1, 2, ... frames, up to one less than the lag; none of a lag of one frame.
    """

    matrices: tuple[sparse.csr_array, ...]

    @property
    def lag(self) -> int:
        """Frames in a step."""
        return len(self.matrices) + 1

    def later(self, frames: int, shares: Array) -> Array:
        """Shares of the particles of each cell on each side after so many frames, as (n_groups, n_cells)."""
        return np.asarray((self.matrices[frames - 1] @ shares.T).T)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The matrices as plain arrays, for the file of a chain."""
        return {
            FRACTION.format(frames, part): getattr(matrix, part)
            for frames, matrix in enumerate(self.matrices, 1)
            for part in PARTS
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "Fractions":
        """Matrices among the arrays of a chain; none where it was stored without."""
        matrices: list[sparse.csr_array] = []
        while FRACTION.format(len(matrices) + 1, "data") in arrays:
            parts = tuple(arrays[FRACTION.format(len(matrices) + 1, part)] for part in PARTS)
            size = parts[2].size - 1
            matrices.append(sparse.csr_array(parts, shape=(size, size)))
        return cls(tuple(matrices))


def learn_fractions(
    frames: Frames, n_cells: int, lag: int, estimator: str = "pooled",
    weights: Callable[[int], NDArray[np.int64]] | None = None,
) -> Fractions:  # fmt: skip
    """Matrices of all lags shorter than a step.

    Parameters
    ----------
    frames : Frames
        The learning window.
    n_cells : int
    lag : int
        Frames in a step.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    weights : callable, optional
        From a lag to how many times the step of that lag from each frame counts; 1 by default.

    Returns
    -------
    Fractions
    """
    cells, matrices = np.asarray(frames.cells), []
    for shorter in range(1, lag):
        counts = count_moves(cells, n_cells, shorter, step_weights=weights and weights(shorter))
        matrices.append(transition_matrix(counts, estimator))
    return Fractions(tuple(matrices))


def fractions_relearner(
    frames: Frames, n_cells: int, lag: int, estimator: str = "pooled"
) -> Callable[[NDArray[np.bool_]], Fractions]:
    """`learn_fractions` without some of the `bands.BLOCKS` equal blocks of the window, counted once.

    Returns
    -------
    callable
        From the blocks that are kept, (BLOCKS,) bool, to `Fractions`.
    """
    cells = np.asarray(frames.cells)
    counts = [count_move_blocks(cells, n_cells, shorter) for shorter in range(1, lag)]
    return lambda kept: Fractions(tuple(transition_matrix(each.of(kept), estimator) for each in counts))


def mixing_by_frame(
    chain: Chain, fractions: Fractions | ShareFractions, start: Frames, splits: Splits, length: int,
    rng: np.random.Generator | None = None,
) -> Array:  # fmt: skip
    """Mixing curves of a chain at every frame.

    Parameters
    ----------
    chain : Chain
    fractions : Fractions or ShareFractions
        Of the same lag and cells; the latter of the shares of the same lines.
    start : Frames
        As `Chain.mixing`.
    splits : Splits
    length : int
        Frames after the start.
    rng : numpy Generator, optional
        For a Monte Carlo of every particle at the steps, and the expectation of those between them.

    Returns
    -------
    (length + 1, 4) array
        Share of each group of `mixing.GROUPS` on its side [1].
    """
    lag = fractions.lag
    if lag == 1:
        return chain.mixing(start, *splits, length, rng)
    steps = -(-length // lag)
    marked = sides(np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1]), *splits)
    shares = side_shares(chain.grid, *splits)
    numbers = chain.densities(start, marked, range(steps + 1), rng)
    with np.errstate(invalid="ignore", divide="ignore"):  # a group without particles has no curve
        density = numbers / marked.sum(axis=1)[:, None]
    curves = np.empty((length + 1, len(shares)))
    for frames in range(lag):
        later = shares if frames == 0 else fractions.later(frames, shares)
        part = np.einsum("tgc,gc->tg", density, later)
        curves[frames::lag] = part[: len(curves[frames::lag])]
    if rng is None:
        whole = chain.mixing(start, *splits, steps)
        curves[::lag] = whole[: len(curves[::lag])]
    curves[0] = np.where(marked.any(axis=1), 1.0, np.nan)
    return curves


def densities_at(
    chain: Chain, fractions: Fractions, start: Frames, marked: NDArray[np.bool_], frames: Sequence[int],
    rng: np.random.Generator | None = None,
) -> Array:  # fmt: skip
    """Particles of marked groups in the cells of a chain at any frames.

    Parameters
    ----------
    chain, fractions, start, rng
        As `mixing_by_frame`.
    marked : (n_groups, n_particles) bool array
    frames : sequence of int
        Rising frames after the start.

    Returns
    -------
    (n_frames, n_groups, n_cells) array
    """
    steps, rest = np.divmod(np.asarray(frames, np.int64), fractions.lag)
    whole = np.unique(steps)
    numbers = chain.densities(start, marked, [int(step) for step in whole], rng)
    at_steps = np.asarray(numbers, np.float64)[np.searchsorted(whole, steps)]
    return np.stack(
        [
            now if part == 0 else now @ fractions.matrices[part - 1]
            for now, part in zip(at_steps, rest, strict=True)
        ]
    )
