# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a chain at an extreme, and their checks: mass, probabilities, exact values."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import sides
from bedchain.studies.stability.verdict import REFUSED, Verdict, judge
from bedchain.studies.stability.walkers import HEIGHT, WIDTH
from bedchain.studies.verification.rows import Row
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

ROUND_OFF = 1e-9  # relative: a million steps, each rounded to 1e-16
ROW_SUM = 1e-12
EXACT_STATES = 2000  # up to this many a dense power of the matrix is the judge
SIGMAS = 6.0  # of a Monte Carlo against the expectation, in some hundred cells: by chance once in 10^6 times
DRAWN_STEPS = 20  # of the Monte Carlo, where a chain takes more
CURVE_STEPS = 50
FEW_STEPS = 100  # up to so many, chains without a matrix give expected values too: means over many tracers
MANY_TRACERS = 100_000  # likewise
COLLAPSED = 0.2  # total variation between the long-run density and that of the frames [1]


@dataclass(frozen=True)
class ChainCase:
    """Data that a chain is learned from, and its run.

    Attributes
    ----------
    frames : Frames
        The learning window.
    grid : Grid
    start : Frames
        Frames up to the start.
    lag : int
        Frames in a step.
    steps : int
        Steps to run.
    settled : bool
        Whether the long-run density must be that of the frames.
    options : dict
        Of the model.
    """

    frames: Frames
    grid: Grid
    start: Frames
    lag: int = 1
    steps: int = 40
    settled: bool = False
    options: dict[str, Any] = field(default_factory=dict)


def run_chain(
    model: str, build: Callable[[], ChainCase], learn: Callable[..., Chain] = registry.learn
) -> Verdict:
    """Learn a model from a case, run it and judge it; refused where the model cannot use the data.

    Parameters
    ----------
    model : str
        Of `registry.LEARNERS`.
    build : callable
        Returns the case.
    learn : callable
        As `registry.learn`.
    """
    case = build()
    try:
        chain = learn(model, case.frames, case.grid, case.lag, **case.options)
        return judge([*matrix_rows(chain, case), *density_rows(chain, case), *long_run_rows(chain, case)])
    except DataError as error:
        return Verdict(REFUSED, f"check of {model}'s data", str(error))


def matrix_rows(chain: Chain, case: ChainCase) -> list[Row]:
    """Checks of the probabilities, and of the expected values against powers of the matrix."""
    if not isinstance(chain, MarkovChain):
        return []
    data = chain.matrix.data
    beyond = max(float(-data.min()), float(data.max()) - 1, 0.0)
    sums = np.abs(np.asarray(chain.matrix.sum(axis=1)).ravel() - 1).max()
    rows = [
        Row("probability outside 0 to 1 [1]", beyond, 0, ROW_SUM, "definition"),
        Row("row sum less 1 [1]", float(sums), 0, ROW_SUM, "definition"),
    ]
    n_states = chain.matrix.shape[0]
    if n_states <= EXACT_STATES:
        begin = np.bincount(chain.states(case.start), minlength=n_states).astype(float)
        later = begin @ np.linalg.matrix_power(chain.matrix.toarray(), case.steps)
        exact = np.bincount(chain.cell_of_state, later, chain.grid.n_cells)
        everyone = np.ones((1, begin.sum().astype(int)), bool)
        density = chain.densities(case.start, everyone, [case.steps])[0, 0]
        off = float(np.abs(density - exact).max() / begin.sum())
        rows.append(Row("density off p P^n [1]", off, 0, ROUND_OFF, "dense power of the matrix"))
    return rows


def density_rows(chain: Chain, case: ChainCase) -> list[Row]:
    """Checks that particles are conserved, by expectation and by Monte Carlo."""
    start = case.start
    marked = sides(np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1]), WIDTH / 2, HEIGHT / 2)
    size, number = marked.sum(axis=1), marked.shape[1]
    drawn_at = [0, 1, min(case.steps, DRAWN_STEPS)]
    markov = isinstance(chain, MarkovChain)
    if not markov:
        drawn_at[-1] = case.steps
    drawn = chain.densities(start, marked, drawn_at, np.random.default_rng(5))
    rows = [
        Row("particles lost by a Monte Carlo [1]", _most(drawn.sum(axis=2) - size), 0, 0.5, "they move"),
        Row("fewest particles in a cell [1]", float(min(drawn.min(), 0)), 0, 0.5, "definition"),
    ]
    if markov or (case.steps <= FEW_STEPS and number <= MANY_TRACERS):
        expected = chain.densities(start, marked, [*drawn_at, case.steps])
        rows.append(
            Row("mass lost [1]", _most(expected.sum(axis=2) - size) / number, 0, ROUND_OFF, "Eq. (1)")
        )
        rows.append(Row("least density [1]", min(float(expected.min()), 0.0), 0, ROUND_OFF, "definition"))
        if markov:
            spread = np.sqrt(expected[: len(drawn_at)] + 1)
            off = _most((drawn - expected[: len(drawn_at)]) / spread)
            rows.append(Row("Monte Carlo off, in standard errors [1]", off, 0, SIGMAS, "binomial spread"))
        rows.append(curve_row(chain, case, size))
    return rows


def curve_row(chain: Chain, case: ChainCase, size: NDArray[np.int64]) -> Row:
    """Check that mixing curves are shares, defined for all groups with particles."""
    curves = chain.mixing(case.start, WIDTH / 2, HEIGHT / 2, min(case.steps, CURVE_STEPS))[:, size > 0]
    beyond = np.maximum(np.maximum(-curves, curves - 1), 0)
    return Row("mixing curve outside 0 to 1 [1]", float(beyond.max()), 0, ROUND_OFF, "definition")


def long_run_rows(chain: Chain, case: ChainCase) -> list[Row]:
    """Checks of the long-run density; where it must be settled, against that of the frames."""
    density = chain.long_run_density(case.start)
    rows = [
        Row("sum of the long-run density [1]", float(density.sum()), 1, ROUND_OFF, "definition"),
        Row("least long-run density [1]", min(float(density.min()), 0.0), 0, ROUND_OFF, "definition"),
    ]
    if case.settled:
        seen = np.bincount(np.asarray(case.frames.cells).ravel(), minlength=case.grid.n_cells)
        off = total_variation(density, seen.astype(float))
        rows.append(Row("long-run density off the frames' [1]", off, 0, COLLAPSED, "total variation"))
    return rows


def _most(values: NDArray[Any]) -> float:
    return float(np.abs(values).max())


def rare_moves(probability: float, steps: int, tracers: int) -> Verdict:
    """Verdict of a chain of three cells in a row whose moves all have the same tiny probability.

    Parameters
    ----------
    probability : float
        Of a move to the right [1].
    steps, tracers : int
        Of the Monte Carlo; the expectation takes as many steps.

    Returns
    -------
    Verdict
        The second cell must hold ``n steps p``, the third ``n steps (steps - 1) p^2 / 2``, whatever its size.
    """
    grid = Grid(WIDTH, HEIGHT, 3, 1)
    moves = np.array([[1 - probability, probability, 0], [0, 1 - probability, probability], [0, 0, 1.0]])
    cells = np.arange(3, dtype=np.int32)
    matrix = sparse.csr_array(moves)
    chain = MarkovChain("static", grid, 1, 1.0, matrix, cells, 1, np.zeros(0, np.int64), 0)
    still = np.full((1, tracers), WIDTH / 6)
    start = Frames(np.zeros(1), still, still, np.zeros((1, tracers), np.int32))
    everyone = np.ones((1, tracers), bool)
    density = chain.densities(start, everyone, [steps])[0, 0]
    drawn = chain.densities(start, everyone, [steps], np.random.default_rng(5))[0, 0]
    expected = tracers * steps * probability
    source, near = "binomial, p small", 1e-6 + steps * probability
    return judge(
        [
            Row("expected particles that moved [1]", density[1], expected, near, source),
            Row("mass lost [1]", abs(density.sum() - tracers) / tracers, 0, ROUND_OFF, "Eq. (1)"),
            Row("drawn particles that moved [1]", drawn[1:].sum(), expected,
                (SIGMAS * np.sqrt(expected) + 0.5) / expected, source),
        ]
    )  # fmt: skip
