# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of any simulated bed: nothing lost, nothing outside, the gas carries the weight."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.case.parameters import weight_per_area
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.store import open_trajectory, read_manifest

# a fluidized bed weighs on the gas; floor and side walls carry 2 to 3 % of it, by the window that is averaged
WEIGHT_SHARE = 0.05
# of the weight: the gas's own momentum, faster between particles than above them, and the buoyancy of air
GAS_MOMENTUM = 0.01
# of gravity: what is left of the bed's ups and downs over a window of seconds
MEAN_ACCELERATION = 0.02
# Monte Carlo and solver sums are exact to round-off; this is far above it and far below anything physical
ROUND_OFF = 1e-9
# faster than a particle that falls freely from the top of the bed, or is carried by the gas
FASTEST_FACTOR = 3.0
GRAVITY = 9.81
# of the limit: a sound run stays well below what stops it
OVERLAP_MARGIN = 0.9


@pytest.fixture(scope="module")
def trajectory(results):
    """Memory map and metadata."""
    return open_trajectory(results / "trajectory.npy", results / "trajectory.json")


@pytest.fixture(scope="module")
def series(results):
    """What the solver wrote of the bed over time."""
    return pd.read_csv(results / "bed_series.csv")


def test_every_frame_of_the_case_is_there_once(results, case):
    manifest = read_manifest(results / "dem.json")
    times = np.array([frame["time_s"] for frame in manifest["frames"]])
    interval, archived = case["time"]["frame_interval_s"], "gas" in manifest
    first = times[0] if archived else 0.0
    steps = round((case["time"]["end_s"] - first) / interval)
    np.testing.assert_allclose(times, first + interval * np.arange(steps + 1), atol=1e-9)
    if archived:  # out of its archive: the frames' own files are not in it
        assert first <= case["learning"]["start_s"] and (results / manifest["gas"]).exists()
        return
    files = [results / frame["file"] for frame in manifest["frames"]]
    assert len(set(files)) == len(files)
    assert all(
        file.stat().st_size == frame["bytes"] for file, frame in zip(files, manifest["frames"], strict=True)
    )


def test_particle_number_is_conserved_in_every_frame(trajectory, results, case):
    values, metadata = trajectory
    number = case["particles"]["number"]
    assert metadata["number"] == values.shape[2] == number
    store = open_cells(results / "cells.npz")
    for cells in store.cells:
        held = np.bincount(cells, minlength=store.grid.n_cells)
        assert (held.size, held.sum()) == (store.grid.n_cells, number)


def test_particles_are_in_the_bed_and_move_at_sane_speeds(trajectory, case):
    values, _ = trajectory
    height, width = case["bed"]["height_m"], case["bed"]["width_m"]
    fastest = FASTEST_FACTOR * max(np.sqrt(2 * GRAVITY * height), case["gas"]["superficial_velocity_m_s"])
    for frame in values:
        assert np.isfinite(frame).all()
        assert (frame[0] >= 0).all() and (frame[0] <= np.float32(width)).all()
        assert (frame[1] >= 0).all() and (frame[1] <= np.float32(height)).all()
        assert np.abs(frame[2:]).max() < fastest


def test_the_bed_moves_while_it_is_learned_and_compared(trajectory, case):
    values, metadata = trajectory
    times = np.array(metadata["times_s"])
    for window in ("learning", "comparison"):
        ends = [np.argmin(np.abs(times - case[window][end])) for end in ("start_s", "end_s")]
        moved = np.hypot(*(values[ends[1], :2] - values[ends[0], :2]))
        assert np.median(moved) > 5 * case["particles"]["diameter_m"]


def test_pressure_drop_carries_the_bed(metrics, case):
    share = metrics.loc[("dem", "pressure_drop_over_weight"), "value"]
    assert share == pytest.approx(1, abs=WEIGHT_SHARE)
    weight = metrics.loc[("dem", "weight_per_area"), "value"]
    assert weight == pytest.approx(weight_per_area(case), rel=1e-6)


def test_gas_and_walls_carry_the_whole_weight(series, case):
    window = series[series["time_s"].between(case["learning"]["start_s"], case["comparison"]["end_s"])]
    gas, floor, sides = (window[f"weight_on_{bearer}_1"].mean() for bearer in ("gas", "floor", "sides"))
    assert gas + floor + sides == pytest.approx(1, abs=MEAN_ACCELERATION)
    assert floor > 0
    drop = window["pressure_drop_Pa"].mean()
    assert drop == pytest.approx(gas * weight_per_area(case), rel=GAS_MOMENTUM)


def test_mean_pressure_drop_is_that_of_the_series(metrics, series, case):
    window = series["time_s"].between(case["learning"]["start_s"], case["comparison"]["end_s"])
    mean = series.loc[window, "pressure_drop_Pa"].mean()
    assert metrics.loc[("dem", "pressure_drop_mean"), "value"] == pytest.approx(mean, rel=1e-6)


def test_series_goes_on_from_segment_to_segment(series, case):
    steps = np.diff(series["time_s"])
    np.testing.assert_allclose(steps, np.median(steps), rtol=1e-3)
    assert series["time_s"].iloc[-1] == pytest.approx(case["time"]["end_s"], abs=2 * np.median(steps))
    assert (series["particles_1"] == case["particles"]["number"]).all()
    assert series["smallest_voidage_1"].min() > 0
    assert series["exchange_error_1"].abs().max() < ROUND_OFF


def test_no_voidage_was_clipped_and_no_overlap_came_near_the_limit(series, case):
    assert case["gas"]["voidage_clip"] == "stop"
    assert (series["voidage_clips_1"] == 0).all()
    assert 0 < series["largest_overlap_1"].max() < OVERLAP_MARGIN * case["contact"]["largest_overlap_1"]


def test_segments_join_without_gap(results, case):
    segments = json.loads((results / "dem.json").read_text())["segments"]
    ends = [0.0, *(segment["end_s"] for segment in segments)]
    np.testing.assert_allclose([segment["start_s"] for segment in segments], ends[:-1], atol=1e-9)
    assert ends[-1] >= case["time"]["end_s"] - 1e-9
    for segment in segments:
        parts = segment["dem_s"] + segment["exchange_s"] + segment["gas_s"]
        assert 0 < parts <= 1.01 * segment["wall_s"]
