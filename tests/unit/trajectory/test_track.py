# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks at uneven times: positions by hand, what is dropped, and a known matrix from one tracer."""

import json

import numpy as np
import pytest

from bedchain.chains.counting import count_moves
from bedchain.errors import DataError
from bedchain.trajectory.grid import OUTSIDE, Grid
from bedchain.trajectory.store import open_trajectory
from bedchain.trajectory.track import ergodicity_warning, even_track, resample, visits
from bedchain.uncertainty.bands import block_band, kept_blocks, kept_steps

P = np.array([[0.7, 0.3, 0.0, 0.0], [0.2, 0.5, 0.3, 0.0], [0.0, 0.25, 0.5, 0.25], [0.0, 0.0, 0.4, 0.6]])
GRID, STEP_S = Grid(0.04, 0.01, 4, 1), 0.1


def test_positions_are_on_the_line_between_near_locations_and_the_others_are_dropped():
    times = np.array([1.0, 1.05, 1.12, 1.19, 1.51, 1.6])
    track = even_track(times, np.stack((times, 2 * times)), np.zeros(6, int), 0.1, 0.08)
    # 1.0 to 1.2 and 1.6; of 1.2, 1.3, 1.4 and 1.5 a neighbour is too far
    kept = np.array([True, True, False, False, False, False, True])
    np.testing.assert_allclose(track.times_s, 0.1 * np.arange(7))
    np.testing.assert_allclose(track.positions_m[0, kept, 0], [1.0, 1.1, 1.6])
    np.testing.assert_allclose(track.positions_m[1, kept, 0], [2.0, 2.2, 3.2])
    assert np.isnan(track.positions_m[:, ~kept]).all()
    assert (track.kept, track.dropped) == (3, 4)


def test_several_tracers_have_columns_of_their_own():
    times, tracers = np.array([0.0, 0.0, 0.1, 0.2, 0.2]), np.array([7, 3, 7, 7, 3])
    track = even_track(times, np.arange(5.0)[None], tracers, 0.1, 0.1)
    np.testing.assert_allclose(track.positions_m[0], [[1, 0], [2.5, 2], [4, 3]])


def test_bad_tracks_are_refused():
    times, places, one = np.array([0.0, 1.0, 0.5]), np.zeros((1, 3)), np.zeros(3, int)
    with pytest.raises(DataError, match="tracer 0 is located at 0.5 s after 1 s"):
        even_track(times, places, one, 0.1, 0.1)
    with pytest.raises(DataError, match="location 1 .* is not finite"):
        even_track(np.array([0, np.nan, 1]), places, one, 0.1, 0.1)
    with pytest.raises(DataError, match="both must be positive"):
        even_track(times, places, one, 0.0, 0.1)
    with pytest.raises(DataError, match="no two multiples of 0.1 s .* each 1 s; take a longer reach"):
        even_track(np.array([0.05, 1.05, 2.05]), places, one, 0.1, 0.01)


def located(seed, n_steps=4000):
    """A tracer that moves by the matrix, in the middle of its cell at each step, located at uneven times.

    It rests about each step, jumps between two of them, and is lost in a tenth of the time.
    """
    rng = np.random.default_rng(seed)
    path, draws = np.zeros(n_steps, int), rng.random(n_steps)
    for step in range(1, n_steps):
        path[step] = np.searchsorted(P[path[step - 1]].cumsum(), draws[step])
    times = np.sort(rng.uniform(0, STEP_S * (n_steps - 1), 6 * n_steps))
    lost = np.isin((times // (STEP_S * 5)).astype(int) % 20, [3, 4])
    times = np.concatenate(([0.0], times[~lost]))
    # at rest but for a jump, half a step away from the steps
    return times, 0.005 + 0.01 * path[np.round(times / STEP_S).astype(int)]


def test_a_tracer_recovers_a_known_matrix_within_its_bands_as_often_as_they_say():
    hits, entries, dropped = 0, 0, 0
    for seed in range(12):
        times, x = located(seed)
        track = even_track(times, np.stack((x, np.full(x.size, 0.005))), np.zeros(x.size, int), STEP_S, 0.04)
        cells = GRID.cells_seen(*track.positions_m)
        dropped += track.dropped / (track.kept + track.dropped)
        n_steps = len(cells) - 1

        def matrix(weights, cells=cells):
            moves = count_moves(cells, 4, step_weights=weights).moves.toarray()
            return moves / moves.sum(axis=1, keepdims=True)

        whole = matrix(np.ones(n_steps, int))
        left_out = np.stack([matrix(kept_steps(kept, n_steps)) for kept in kept_blocks()])
        low, high = block_band(whole, left_out, "share")
        inside = (low <= P) & (high >= P)
        hits, entries = hits + int(inside[P > 0].sum()), entries + int((P > 0).sum())
        assert whole[P == 0].max() < 0.02
    assert 0.1 < dropped / 12 < 0.35
    assert 0.88 < hits / entries <= 1.0  # nominal 0.95, of 120 entries


def test_a_short_track_is_warned_of():
    cells = np.array([[0, 1, 1, OUTSIDE, 2, 3]], np.int32).T
    assert visits(cells, 8)["cells_seen_1"] == 4
    assert "too short" in ergodicity_warning(cells, 8, 1)
    again = np.tile([0, 1], 100)[:, None].astype(np.int32)
    words = ergodicity_warning(again, 8, 1)
    assert "2 of 8 cells" in words and "too short" not in words and "ergodicity" in words


def test_a_stored_track_is_written_anew_at_even_times(tmp_path):
    times, x = located(1, 200)
    values = np.full((times.size, 4, 1), np.nan, np.float32)
    values[:, 0, 0], values[:, 1, 0] = x, 0.005
    files = tmp_path / "trajectory.npy", tmp_path / "trajectory.json"
    np.save(files[0], values)
    about = {"times_s": times.tolist(), "number": 1, "columns": ["x", "z", "vx", "vz"]}
    about |= {"width_m": 0.04, "height_m": 0.01, "frame_interval_s": None}
    files[1].write_text(json.dumps(about))
    words = resample(*files, STEP_S, 0.04)
    even, said = open_trajectory(*files)
    track = even_track(times, np.stack((x, np.full(x.size, 0.005))), np.zeros(x.size, int), STEP_S, 0.04)
    np.testing.assert_allclose(even[:, :2, 0].T, track.positions_m[..., 0], rtol=1e-6)
    np.testing.assert_allclose(np.diff(said["times_s"]), STEP_S)
    assert said["frame_interval_s"] == STEP_S and said["width_m"] == 0.04 and not said["complete"]
    assert f"{track.kept} positions" in words and f"{track.dropped} (" in words
