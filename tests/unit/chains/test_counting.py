# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts of moves and of pairs against plain loops, and their properties."""

from collections import Counter, defaultdict

import numpy as np
import pytest
from deeptime.markov import TransitionCountEstimator
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bedchain.array_files import map_array
from bedchain.chains.counting import Counts, count_moves, count_pairs
from bedchain.errors import DataError
from bedchain.trajectory import chunks
from bedchain.trajectory.grid import OUTSIDE, Grid
from made.frames import hopping_cells

# Shares are sums of at most a few hundred fractions.
ROUND_OFF = 1e-12


def naive(
    cells: np.ndarray, lag: int, moves: int, weights: list[int] | None = None
) -> tuple[Counter, dict, Counter]:
    """Counts, sums of shares and occupied steps by plain loops; keys are tuples of cells."""
    counts: Counter = Counter()
    shares: dict = defaultdict(float)
    occupied: Counter = Counter()
    for start in range(len(cells) - moves * lag):
        now = [tuple(int(cells[start + k * lag, p]) for k in range(moves + 1)) for p in range(cells.shape[1])]
        held = Counter(path[:-1] for path in now)
        for _ in range(1 if weights is None else weights[start]):
            for path in now:
                counts[path] += 1
                shares[path] += 1 / held[path[:-1]]
            occupied.update(held.keys())
    return counts, shares, occupied


def by_path(counts: Counts) -> tuple[Counter, Counter, Counter]:
    """Counts, sums of shares and occupied steps, by tuples of cells."""
    froms = counts.pairs.tolist() if counts.pairs is not None else [[cell] for cell in range(counts.n_cells)]
    moves, shares = counts.moves.tocoo(), counts.shares.tocoo()
    paths = [(*froms[row], int(column)) for row, column in zip(moves.row, moves.col, strict=True)]
    occupied = zip(map(tuple, froms), counts.occupied.tolist(), strict=True)
    return (
        Counter(dict(zip(paths, moves.data.tolist(), strict=True))),
        Counter(dict(zip(paths, shares.data.tolist(), strict=True))),
        Counter({path: steps for path, steps in occupied if steps}),
    )


def assert_same(measured: tuple[Counter, Counter, Counter], expected: tuple[Counter, dict, Counter]) -> None:
    assert measured[0] == expected[0] and measured[2] == expected[2]
    assert measured[1] == pytest.approx(expected[1], abs=ROUND_OFF)


def test_one_particle_at_lag_two():
    cells = np.array([[0, 0, 0, 0, 1, 1, 0, 1]], np.int32).T
    assert count_moves(cells, 2, lag=2).moves.toarray().tolist() == [[2, 2], [1, 1]]


def test_two_particles_by_hand():
    counts = count_moves(np.array([[0, 0], [0, 1], [1, 1]], np.int32), 3)
    assert counts.moves.toarray().tolist() == [[1, 2, 0], [0, 1, 0], [0, 0, 0]]
    assert counts.shares.toarray().tolist() == [[0.5, 1.5, 0], [0, 1, 0], [0, 0, 0]]
    assert counts.occupied.tolist() == [2, 1, 0]
    assert counts.visits.tolist() == [3, 1, 0]
    assert counts.steps == 2


def test_pairs_by_hand():
    counts = count_pairs(np.array([[0, 2], [1, 2], [0, 2], [1, 0]], np.int32), 3)
    assert counts.pairs.tolist() == [[0, 1], [1, 0], [2, 2]]
    assert counts.moves.toarray().tolist() == [[1, 0, 0], [0, 1, 0], [1, 0, 1]]
    assert counts.steps == 2


@pytest.mark.parametrize("lag", [1, 2, 5])
@pytest.mark.parametrize("moves", [1, 2])
def test_agrees_with_plain_loops(lag, moves):
    count = count_moves if moves == 1 else count_pairs
    for seed in range(3):
        cells = hopping_cells(seed)
        assert_same(by_path(count(cells, 12, lag)), naive(cells, lag, moves))


@st.composite
def trajectories(draw):
    """Cells of a few particles in a few frames, a lag that fits twice, and how often each step counts."""
    lag, frames = draw(st.integers(1, 3)), draw(st.integers(7, 12))
    cells = draw(arrays(np.int32, (frames, draw(st.integers(1, 5))), elements=st.integers(0, 4)))
    weights = draw(st.lists(st.integers(0, 3), min_size=frames - lag, max_size=frames - lag))
    weights[0] += 1
    return cells, lag, weights


@given(trajectories())
def test_counts_are_those_of_loops_add_up_and_need_no_order_of_particles(given_trajectory):
    cells, lag, weights = given_trajectory
    for count, moves in ((count_moves, 1), (count_pairs, 2)):
        steps = weights[: len(cells) - moves * lag]
        counts = count(cells, 5, lag, step_weights=np.array(steps))
        assert_same(by_path(counts), naive(cells, lag, moves, steps))
        assert counts.moves.sum() == sum(steps) * cells.shape[1] == counts.visits.sum()
        assert counts.shares.sum() == pytest.approx(counts.occupied.sum(), abs=ROUND_OFF)
        turned = count(np.ascontiguousarray(cells[:, ::-1]), 5, lag, step_weights=np.array(steps))
        assert (turned.moves != counts.moves).nnz == 0 and (turned.occupied == counts.occupied).all()


def test_agrees_with_deeptime():
    cells = hopping_cells(4)
    for lag in (1, 3):
        model = TransitionCountEstimator(lag, "sliding", n_states=12).fit_fetch(
            [np.ascontiguousarray(p) for p in cells.T]
        )
        assert (model.count_matrix == count_moves(cells, 12, lag).moves.toarray()).all()


def test_chunks_change_nothing(monkeypatch, tmp_path):
    cells = hopping_cells(6)
    np.savez(tmp_path / "cells.npz", other=np.arange(3.0), cells=cells)
    whole = [count_moves(cells, 12, 3), count_pairs(cells, 12, 3)]
    monkeypatch.setattr(chunks, "CHUNK_BYTES", 4 * cells[0].nbytes)
    mapped = map_array(tmp_path / "cells.npz", "cells")
    assert isinstance(mapped, np.memmap)
    for array in (cells, mapped, mapped[:]):
        parts = [count_moves(array, 12, 3), count_pairs(array, 12, 3)]
        for one, two in zip(whole, parts, strict=True):
            assert (one.moves != two.moves).nnz == 0 and (one.occupied == two.occupied).all()
            assert abs(one.shares - two.shares).max() < ROUND_OFF  # sums of the chunks' sums


def test_a_cell_a_diameter_keeps_only_what_occurs():
    n_cells = 270 * 1050
    cells = np.random.default_rng(3).integers(0, n_cells, (4, 20_000), dtype=np.int32)
    counts = count_moves(cells, n_cells)
    assert counts.moves.sum() == 60_000 and counts.moves.nnz <= 60_000
    double = count_pairs(cells, n_cells)
    assert double.moves.sum() == 40_000 and len(double.pairs) <= 40_000


def test_bad_input_is_refused():
    cells = hopping_cells(1)
    with pytest.raises(DataError, match="hold no step"):
        count_moves(cells, 12, 30)
    with pytest.raises(DataError, match="hold no step"):
        count_pairs(cells, 12, 15)
    with pytest.raises(DataError, match="window is empty"):
        count_moves(cells, 12, first=40, last=50)
    with pytest.raises(DataError, match="28 step weights for 29 steps"):
        count_moves(cells, 12, step_weights=np.ones(28, int))
    with pytest.raises(DataError, match="none negative"):
        count_moves(cells, 12, step_weights=np.arange(29) - 1)
    with pytest.raises(DataError, match="weights are 0"):
        count_moves(cells, 12, step_weights=np.zeros(29, int))
    with pytest.raises(DataError, match="frames, particles"):
        count_moves(cells[0], 12)
    cells[7, 31] = 12
    with pytest.raises(DataError, match=r"particle 31 .*frame 7 is in cell 12, the grid has cells 0 to 11"):
        count_moves(cells, 12)


@pytest.mark.parametrize(("count", "moves"), [(count_moves, 1), (count_pairs, 2)])
def test_counts_of_seven_parts_of_a_window_add_up_to_those_of_the_whole(count, moves):
    cells, lag = hopping_cells(5, n_frames=60), 2
    starts = np.arange(60 - moves * lag)
    edges = [0, 5, 6, 20, 31, 40, 52, 60]
    parts = [
        count(cells, 12, lag, step_weights=((low <= starts) & (starts < high)).astype(int))
        for low, high in zip(edges, edges[1:], strict=False)
    ]
    whole = count(cells, 12, lag)
    sums = tuple(sum(column, Counter()) for column in zip(*map(by_path, parts), strict=True))
    assert_same(sums, by_path(whole))
    assert sum(part.steps for part in parts) == whole.steps


def test_first_and_last_choose_the_steps_of_a_part():
    cells = hopping_cells(11)
    weights = np.zeros(28, int)
    weights[9:20] = 1
    part = count_moves(cells, 12, 2, first=9, last=20)
    assert_same(by_path(part), by_path(count_moves(cells, 12, 2, step_weights=weights)))
    assert part.steps == 11
    assert_same(by_path(count_moves(cells, 12, 2, first=9, last=99)), naive(cells[9:], 2, 1))


def come_and_go(seed, n_frames=30, n_particles=200):
    """Hopping particles, of which stretches of time are missing."""
    cells = hopping_cells(seed, n_frames, n_particles)
    rng = np.random.default_rng(seed)
    for particle in range(0, n_particles, 3):
        first, last = np.sort(rng.integers(0, n_frames + 1, 2))
        cells[first:last, particle] = OUTSIDE
    return cells


def test_only_moves_with_both_ends_seen_count_and_the_others_are_lost_or_inserted():
    cells, weights = come_and_go(3), np.random.default_rng(1).integers(0, 3, 28)
    counts = count_moves(cells, 12, 2, step_weights=weights)
    moves, lost, inserted = np.zeros((12, 12), int), np.zeros(12, int), np.zeros(12, int)
    for step, weight in enumerate(weights):
        for i, j in zip(cells[step], cells[step + 2], strict=True):
            if i >= 0 and j >= 0:
                moves[i, j] += weight
            elif i >= 0:
                lost[i] += weight
            elif j >= 0:
                inserted[j] += weight
    assert lost.sum() > 0 and inserted.sum() > 0
    np.testing.assert_array_equal(counts.moves.toarray(), moves)
    np.testing.assert_array_equal([counts.lost, counts.inserted], [lost, inserted])
    # a share is of the particles that were seen again: the rows of each step sum to 1
    np.testing.assert_allclose(counts.shares.sum(axis=1), counts.occupied, atol=1e-9)


def test_pairs_with_a_particle_that_is_not_there_do_not_count():
    cells = come_and_go(4)
    counts = count_pairs(cells, 12, 2)
    by_hand = Counter()
    for i, j, k in zip(cells[:-4].ravel(), cells[2:-2].ravel(), cells[4:].ravel(), strict=True):
        if min(i, j, k) >= 0:
            by_hand[int(i), int(j), int(k)] += 1
    rows, columns = counts.moves.nonzero()
    pairs = [(*map(int, counts.pairs[row]), int(column)) for row, column in zip(rows, columns, strict=True)]
    assert dict(zip(pairs, counts.moves.data.tolist(), strict=True)) == dict(by_hand)
    assert counts.occupied.min() > 0 and len(counts.pairs) == counts.moves.shape[0]


def test_where_all_are_always_there_nothing_is_lost():
    counts = count_moves(hopping_cells(1), 12)
    assert counts.lost is None and counts.inserted is None
    with pytest.raises(DataError, match="is in cell -2"):
        count_moves(hopping_cells(1) - 2, 12)


def test_a_grid_in_three_dimensions_keeps_only_what_occurs():
    grid, rng = Grid(0.1, 0.2, 100, 200, 0.1, 100), np.random.default_rng(3)
    x, z, y = (length * rng.random((3, 20_000)) for length in grid.size)
    counts = count_moves(grid.cell_of(x, z, y_m=y), grid.n_cells)
    assert grid.n_cells == 2_000_000
    assert counts.moves.sum() == 40_000 and counts.moves.nnz <= 40_000
