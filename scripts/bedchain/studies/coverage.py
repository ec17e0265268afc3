# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the bands of `uncertainty.bands` hold the truth: processes that know it, and simulated beds."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import signal, stats

from bedchain.chains import registry
from bedchain.measures.mixing import Splits
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import on_grid, persistent_walk
from bedchain.uncertainty.bands import (
    Array,
    block_band,
    block_edges,
    correlation_steps,
    kept_blocks,
    means_left_out,
    memory,
)

# correlation times in a window, of the processes and of the walk
TIMES = (5, 10, 20, 40, 120)
SAMPLES = 2000
# AR(1) of this correlation of neighbours has a correlation time of 9 steps
NEIGHBOURS = 0.8
# gusts: particles in two cells leave readily while a series is above a level, as those of one bubble do
GUSTY, LEVEL, PARTICLES = 0.95, 0.5, 40
LEAVING = (0.02, 0.3)
# the walk: a box [m], memory of the velocity [s] and speed [m/s]; cells; moments of the curves [steps]
BOX_M, MEMORY_S, SPEED_M_S = (0.1, 0.1), 0.1, 0.2
WALKERS, WALK_GRID, WALK_STEPS = 100, Grid(0.1, 0.1, 4, 4), (10, 20, 40)
# frames of the walk that are the truth, in windows
TRUTH = 60
# moments of the curves of beds [steps]
BED_STEPS = 40


class Covered(NamedTuple):
    """Bands that held the truth.

    Attributes
    ----------
    process : str
    correlation_times_1 : float
        In a window [1].
    covered_1 : float
        Share of the bands that hold the truth [1].
    samples_1 : int
        Bands.
    windows_1 : int
        Independent windows; the bands of one window are not independent.
    """

    process: str
    correlation_times_1: float
    covered_1: float
    samples_1: int
    windows_1: int


def ar1_rows(times: Sequence[int], samples: int, rng: np.random.Generator) -> Iterator[Covered]:
    """Mean of a Gaussian series whose neighbours correlate."""
    time = (1 + NEIGHBOURS) / (1 - NEIGHBOURS)
    for number in times:
        series = _gaussian(round(number * time), samples, NEIGHBOURS, rng)
        low, high = block_band(series.mean(axis=0), means_left_out(series))
        yield Covered("mean of an AR(1) series", number, _share(low, high, 0.0), samples, samples)


def gust_rows(times: Sequence[int], samples: int, rng: np.random.Generator) -> Iterator[Covered]:
    """Probability of leaving a cell, which gusts drive for all particles at once."""
    truth = LEAVING[0] + (LEAVING[1] - LEAVING[0]) * stats.norm.sf(LEVEL)
    time = correlation_steps((_gaussian(1_000_000, 1, GUSTY, rng)[:, 0] > LEVEL).astype(float))
    for number in times:
        held, left = _gusts(round(number * time), samples, rng)
        edges = block_edges(len(held))[:-1]
        parts = [np.add.reduceat(counts, edges, axis=0) for counts in (left, held)]
        without = (parts[0].sum(axis=0) - parts[0]) / (parts[1].sum(axis=0) - parts[1])
        low, high = block_band(left.sum(axis=0) / held.sum(axis=0), without, "share")
        yield Covered("leaving probability, gusts", number, _share(low, high, truth), samples, samples)


def _gaussian(n: int, samples: int, rho: float, rng: np.random.Generator) -> Array:
    noise = rng.normal(0, np.sqrt(1 - rho**2), (n, samples))
    noise[0] = rng.normal(size=samples)
    return np.asarray(signal.lfilter([1], [1, -rho], noise, axis=0))


def _gusts(n: int, samples: int, rng: np.random.Generator) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Particles in the first of two cells at each step, and those that leave it; (n, samples) each."""
    chance = np.where(_gaussian(n, samples, GUSTY, rng) > LEVEL, LEAVING[1], LEAVING[0])
    held, left = np.empty((2, n, samples), np.int64)
    now = rng.binomial(PARTICLES, 0.5, samples)
    for step in range(n):
        held[step], left[step] = now, rng.binomial(now, chance[step])
        now = now - left[step] + rng.binomial(PARTICLES - now, chance[step])
    return held, left


def walk_rows(times: Sequence[int], windows: int, seed: int) -> Iterator[Covered]:
    """Mixing curves of the static chain of walkers that keep their velocity for a while."""
    splits = Splits(BOX_M[0] / 2, BOX_M[1] / 2)
    size = (WALKERS, BOX_M, MEMORY_S, SPEED_M_S)
    time = memory(persistent_walk(4000, *size, seed), splits.split_x_m)
    for number in times:
        n_frames = round(number * time) + 1
        longer = on_grid(persistent_walk(TRUTH * n_frames, *size, seed + 1), WALK_GRID)
        chain = registry.learn("static", longer, WALK_GRID)
        held, start = [], longer.part(slice(0, 1))
        truth = chain.mixing(start, *splits, max(WALK_STEPS))[list(WALK_STEPS)]
        for window in range(windows):
            frames = on_grid(persistent_walk(n_frames, *size, seed + 2 + window), WALK_GRID)
            curves = curves_left_out("static", frames, WALK_GRID, splits, start, WALK_STEPS)
            held.append(_held(*curves, truth, 1 / TRUTH))
        yield Covered("mixing of a persistent walk", number, float(np.mean(held)), 12 * windows, windows)


def bed_rows(
    name: str, frames: Frames, grid: Grid, splits: Splits, times: Sequence[int], models: Sequence[str]
) -> Iterator[Covered]:
    """Mixing curves of chains of a window, against those of chains learned from the rest of the run.

    Parameters
    ----------
    name : str
        Of the bed.
    frames : Frames
        A steady run.
    grid : Grid
    splits : Splits
    times : sequence of int
        Correlation times in a window; windows overlap by half, and there must be two apart.
    models : sequence of str

    Yields
    ------
    Covered
        For each number and model. The truth is not exact: bands are wider by the root of 1 + window / rest.
    """
    time, start = memory(frames, splits.split_x_m), frames.part(slice(0, 3))
    steps = range(BED_STEPS // 4, BED_STEPS + 1, BED_STEPS // 4)
    n_frames = len(frames.times_s)
    for length in [round(number * time) + 1 for number in times if 2 * number * time < n_frames]:
        for model in models:
            held = []
            for first in range(0, n_frames - length + 1, length // 2):
                weights = np.ones(n_frames - 1, np.int64)
                weights[max(first - 1, 0) : first + length] = 0
                rest = registry.learn(model, frames, grid, step_weights=weights)
                truth = rest.mixing(start, *splits, BED_STEPS)[list(steps)]
                window = frames.part(slice(first, first + length))
                curves = curves_left_out(model, window, grid, splits, start, steps)
                held.append(_held(*curves, truth, length / (n_frames - length)))
            yield Covered(
                f"mixing of the {model} chain, {name} bed",
                length / time,
                float(np.mean(held)),
                np.size(held),
                n_frames // length,
            )


def curves_left_out(
    model: str, frames: Frames, grid: Grid, splits: Splits, start: Frames, steps: Sequence[int]
) -> tuple[Array, Array]:
    """Mixing curves of a window's chain, (n_steps, 4), and without each block, (BLOCKS, n_steps, 4)."""
    relearn = registry.relearner(model, frames, grid)

    def curves(kept: NDArray[np.bool_]) -> Array:
        return relearn(kept).mixing(start, *splits, max(steps))[list(steps)]

    return curves(np.ones(len(kept_blocks()), bool)), np.stack([curves(kept) for kept in kept_blocks()])


def _held(value: Array, left_out: Array, truth: Array, error: float) -> NDArray[np.bool_]:
    """Truth inside the band, which is wider for a truth whose variance is a share of the window's."""
    spread = left_out.mean(axis=0) + np.sqrt(1 + error) * (left_out - left_out.mean(axis=0))
    low, high = block_band(value, spread, "share")
    return (low <= truth) & (truth <= high)


def _share(low: Array, high: Array, truth: float) -> float:
    return float(((low <= truth) & (truth <= high)).mean())
