# SPDX-License-Identifier: GPL-3.0-or-later
"""Five folds: a loop over the moves outside a block, and starts inside it."""

import numpy as np
import pytest

from bedchain.measures.mixing import Splits, remaining_from_positions, side_shares, sides
from bedchain.studies.candidates import Candidate
from bedchain.studies.five_folds import over_folds, squared_errors, starts_by_fold
from bedchain.studies.scan import Task
from bedchain.trajectory.grid import Grid
from made.frames import walkers


def test_each_block_is_predicted_by_a_chain_that_has_not_seen_it():
    run, where = walkers(60), Task(Grid(0.1, 0.1, 4, 4), Splits(0.05, 0.05), "pooled", 5, 20)
    frames = run.frames(where.grid, slice(0, 61))
    squares = squared_errors(Candidate("static", 4, 4, 2), run, frames, slice(0, 61), where)
    cells = frames.cells
    # the third block is frames 24 to 36; no step may have a frame inside it

    def matrix_of(lag):
        counts = np.zeros((16, 16))
        for start in (start for start in range(61 - lag) if start + lag <= 24 or start >= 36):
            np.add.at(counts, (cells[start], cells[start + lag]), 1)
        return counts / counts.sum(axis=1, keepdims=True)

    whole, half, errors = matrix_of(2), matrix_of(1), []
    shares = side_shares(where.grid, *where.splits)
    for begin in (24, 30):
        observed = remaining_from_positions(run.values[begin:37, 0], run.values[begin:37, 1], *where.splits)
        marked = sides(run.values[begin, 0], run.values[begin, 1], *where.splits)
        now = np.array([np.bincount(cells[begin][group], minlength=16) for group in marked], float)
        for frame in range(1, 37 - begin):
            now = now @ whole if frame % 2 == 0 else now
            share = ((now @ half if frame % 2 else now) * shares).sum(axis=1) / marked.sum(axis=1)
            errors.append((share - observed[frame]) ** 2)
    assert len(squares) == 5
    np.testing.assert_allclose(squares[2], errors, atol=1e-12)
    rms, low, high = over_folds(squares)
    assert rms == pytest.approx(np.sqrt(np.mean(np.concatenate(squares)))) and low < rms < high


def test_starts_of_each_block_are_inside_it_with_a_past_for_two_steps():
    starts = starts_by_fold(slice(0, 61), 3, 5)
    assert [of_block[0].frame for of_block in starts] == [6, 12, 24, 36, 48]
    assert [of_block[0].last for of_block in starts] == [12, 24, 36, 48, 60]
