# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost and error of the case's own chains and of the presets, out of sample, beside another DEM run's.

All chains are learned on the whole learning window and run from every start in the comparison window. Errors
are rms of the four mixing curves at every frame after the start.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.case.chosen import Chosen
from bedchain.case.presets import Preset, with_preset
from bedchain.case.schema import Case
from bedchain.chains.fraction_shares import ShareFractions, learn_share_fractions
from bedchain.errors import DataError, UserError
from bedchain.measures.mixing import side_shares
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.scan import Task, learned, predicted_curves, timed
from bedchain.studies.scores.held_out import HeldOut
from bedchain.trajectory.frames import lag_frames
from bedchain.uncertainty.bands import block_band, block_edges
from bedchain.uncertainty.deviations import deviations, rms, stacked
from bedchain.uncertainty.noise_floor import floor_of

Array = NDArray[np.float64]
Row = dict[str, Any]
ANOTHER = "another DEM run"
EARLIER = "the DEM's own learning window"
OWN = ("static", "dynamic")  # the paper's chains, at the case's own lag and cells


@dataclass(frozen=True)
class NamedChain:
    """A chain to be scored.

    Attributes
    ----------
    name : str
        Of the model, or of the preset.
    candidate : Candidate or None
        Its settings; None where the preset does not go with the case.
    problem : str
        Why it does not; else empty.
    """

    name: str
    candidate: Candidate | None
    problem: str = ""


@dataclass(frozen=True)
class Realised:
    """What the chains are compared with.

    Attributes
    ----------
    held : HeldOut
        Curves from all starts of all runs whose positions are there.
    repeats : (n_repeats, n_frames, 4) array
        Curves of all repeats from the window's first frame on; may be empty [1].
    correlation_times : float
        In the comparison window [1].
    earlier : (n_starts, n_frames, 4) array
        Curves of the DEM from starts in the learning window, NaN after a start's last frame [1].
    """

    held: HeldOut
    repeats: Array
    correlation_times: float
    earlier: Array

    @property
    def spread(self) -> Array:
        """Deviations of the curves of all starts from their mean, (n_starts, n_frames, 4) [1]."""
        curves = self.held.curves
        return deviations(curves, np.zeros(len(curves), np.int64))[:, 1:]

    @property
    def noise_floor(self) -> float:
        """Spread of realisations of the window's first start; NaN without repeats [1]."""
        if not len(self.repeats):
            return float("nan")
        return floor_of(np.stack([self.held.curves[0], *self.repeats])[:, 1:])


def chains_of(
    case: Case, presets: Sequence[Preset], chosen: Chosen, interval_s: float
) -> list[NamedChain]:  # fmt: skip
    """The case's own chains and those of the presets.

    Parameters
    ----------
    case : Case
        Without the value auto.
    presets : sequence of Preset
    chosen : Chosen
        What stands for auto in a preset.
    interval_s : float
        Between frames [s].
    """
    cells, lag = case["cells"], lag_frames(case["chain"]["lag_s"], interval_s)
    own = [name for name in OWN if name in case["chain"]["models"]]
    chains = [NamedChain(name, Candidate(name, cells["columns"], cells["rows"], lag)) for name in own]
    for preset in presets:
        try:
            changed = with_preset(case, preset)
        except UserError as problem:
            chains.append(NamedChain(preset.name, None, str(problem)))
            continue
        columns, rows = (
            getattr(chosen, side) if preset.cell_m == "auto" else changed["cells"][side]
            for side in ("columns", "rows")
        )
        lag_s = chosen.lag_s if preset.lag_s == "auto" else changed["chain"]["lag_s"]
        candidate = Candidate(preset.model, columns, rows, lag_frames(lag_s, interval_s))
        chains.append(NamedChain(preset.name, candidate))
    return chains


def preset_rows(chains: Sequence[NamedChain], learning: slice, realised: Realised, task: Task) -> list[Row]:
    """Cost and errors of all chains, and first what the DEM has: another run, and its learning window.

    Parameters
    ----------
    chains : sequence of NamedChain
    learning : slice
        Frames of the learning window of the first run.
    realised : Realised
    task : Task

    Returns
    -------
    list of dict
        chain, model, columns, rows, cell_m, lag_s, cost (learn_s, between_s, run_s, cost_s), starts,
        `error_columns`, problem.
    """
    rows = [
        {"chain": ANOTHER, "starts": len(realised.held.starts)} | another_run(realised),
        {"chain": EARLIER, "starts": len(realised.earlier)} | learning_window(realised),
    ]
    for chain in chains:
        if chain.candidate is None:
            rows.append({"chain": chain.name, "problem": chain.problem})
            continue
        grid = grid_of(chain.candidate, task.grid)
        row = {
            "chain": chain.name, "model": chain.candidate.model, "columns": grid.columns, "rows": grid.rows,
            "cell_m": float(np.sqrt(grid.cell_width_m * grid.cell_height_m)),
            "lag_s": chain.candidate.lag * realised.held.interval_s, "starts": len(realised.held.starts),
        }  # fmt: skip
        try:
            curves, cost = predicted(chain.candidate, learning, realised.held, task)
        except DataError as problem:
            rows.append(row | {"problem": str(problem)})
            continue
        rows.append(row | cost | error_columns(curves - realised.held.curves, realised))
    return rows


def predicted(
    candidate: Candidate, learning: slice, held: HeldOut, task: Task
) -> tuple[Array, dict[str, float]]:  # fmt: skip
    """Curves of a chain from every start, and its cost.

    Returns
    -------
    curves : (n_starts, n_frames, 4) array
        NaN after a start's last frame [1].
    cost : dict
        Processor time: learn_s of the chain, between_s of the shares a fraction of a step later
        (`fraction_shares`), run_s of the curves of one start, cost_s of all [s].
    """
    run = held.runs[0]
    grid, lag = grid_of(candidate, task.grid), candidate.lag
    frames = run.frames(grid, learning)
    few = frames.part(slice(0, 2 * lag + 2))  # compiles what is timed
    learned(candidate, few, task).mixing(few, *task.splits, 1)
    learn_share_fractions(few, side_shares(grid, *task.splits), 2, task.estimator)
    chain, learn_s = timed(lambda: learned(candidate, frames, task))

    def shares() -> ShareFractions:
        return learn_share_fractions(frames, side_shares(grid, *task.splits), lag, task.estimator)[0]

    fractions, between_s = timed(shares)

    def of(number: int) -> Array:
        start = held.starts[number]
        return predicted_curves(chain, held.runs[start.run], start, lag, task.splits, fractions)

    first, run_s = timed(lambda: of(0))
    cost = {"learn_s": learn_s, "between_s": between_s, "run_s": run_s}
    curves = stacked([first, *map(of, range(1, len(held.starts)))])
    return curves, cost | {"cost_s": sum(cost.values())}


def error_columns(error: Array, realised: Realised) -> Row:
    """Errors of a chain in both units.

    Parameters
    ----------
    error : (n_starts, n_frames, 4) array
        Chain - DEM, from the start on [1].
    realised : Realised

    Returns
    -------
    dict
        error_1 over all starts and spread_of_starts_1; over_spread_1, their ratio, with ci_low_1 and
        ci_high_1 from leaving five blocks of the comparison window out in turn; single_error_1 of the first
        start, noise_floor_1, over_floor_1, their ratio; NaN where there is no second start or realisation.
    """
    error = error[:, 1:]
    # the spread at the times of the error
    spread = np.where(np.isfinite(error).any(axis=0), realised.spread, np.nan)
    ratio = _ratio(error, spread)
    blocks = blocks_of_frames(realised.held)
    left_out = [
        _ratio(np.where(hidden, np.nan, error), np.where(hidden, np.nan, spread))
        for hidden in (blocks == block for block in range(blocks.max() + 1))
    ]
    low, high = block_band(ratio, np.array(left_out), "positive", realised.correlation_times)
    single, floor = float(rms(error[:1])), realised.noise_floor
    return {
        "error_1": float(rms(error)), "spread_of_starts_1": float(rms(spread)), "over_spread_1": ratio,
        "ci_low_1": float(low), "ci_high_1": float(high), "single_error_1": single, "noise_floor_1": floor,
        "over_floor_1": single / floor,
    }  # fmt: skip


def another_run(realised: Realised) -> Row:
    """The columns of `error_columns` of another start of the DEM, and of its repeats from the same start."""
    spread, floor = float(rms(realised.spread)), realised.noise_floor
    row = {"error_1": np.sqrt(2) * spread, "spread_of_starts_1": spread, "over_spread_1": float(np.sqrt(2))}
    if np.isnan(floor):
        return row
    single = float(rms((realised.repeats - realised.held.curves[0])[:, 1:]))
    return row | {"single_error_1": single, "noise_floor_1": floor, "over_floor_1": single / floor}


def learning_window(realised: Realised) -> Row:
    """The columns of `error_columns` of the DEM's curves from the learning window, all pairs of starts.

    A bed whose flow lasts as long as the windows is not the same in both: its starts in one window are alike,
    and their spread does not say what another one does. This row does.
    """
    earlier, held = realised.earlier, realised.held.curves
    length = min(earlier.shape[1], held.shape[1])
    squares = (earlier[:, None, :length] - held[:, :length]) ** 2
    pairs = np.isfinite(squares).sum(axis=0)
    mean = np.divide(np.nansum(squares, axis=0), pairs, out=np.full(pairs.shape, np.nan), where=pairs > 0)
    error = np.full(held.shape, np.nan)
    error[:, :length] = np.sqrt(mean)
    return error_columns(error, realised)


def blocks_of_frames(held: HeldOut) -> NDArray[np.int64]:
    """Block of time of each frame after each start, (n_starts, n_frames, 1); the same in all runs."""
    first = {start.run: start.frame for start in reversed(held.starts)}
    frames = np.arange(1, held.curves.shape[1])
    edges = block_edges(max(start.last - first[start.run] for start in held.starts))
    since = np.array([start.frame - first[start.run] for start in held.starts])
    return np.searchsorted(edges[1:-1], since[:, None] + frames - 1, side="right")[:, :, None]


def _ratio(error: Array, spread: Array) -> float:
    return float(rms(error) / rms(spread))
