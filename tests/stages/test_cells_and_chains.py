# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells, transitions and chains of a bed whose motion is known."""

import numpy as np
import pandas as pd
import pytest

from assign_cells import Division, assign_cells
from bedchain.chains import registry
from bedchain.chains.registry import ModelSettings
from bedchain.errors import DataError, UserError
from bedchain.measures.batch import Batch
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.frames import Window
from bedchain.uncertainty import bands
from build_transitions import build_transitions
from compare_mixing import SolverSeries, Tables, compare_mixing
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    FILLED,
    HEIGHT,
    LEARN,
    MODELS,
    MOMENTS,
    NUMBER,
    ROWS,
    SPLITS,
    TIMES,
    WEIGHT_PA,
    WIDTH,
)
from made.synthetic_bed import SERIES_NOISE
from run_chain import moment_frames, run_chain

STEPS = 40
# exact propagation of a row-stochastic matrix: round-off of some tens of steps
ROUND_OFF = 1e-12
# standard errors that one Monte Carlo of some hundred particles may be off, over 160 values
SIGMAS = 4.5
# cells of 1 cm blur the rolls: particles are spread over a cell at each step; 0.05 to 0.08 were measured
BLUR = 0.1
# four standard errors of the mean of the 750 rows in the learning window
MEAN_ERROR = 4 * SERIES_NOISE / 750**0.5


def test_cells_are_those_of_the_positions(bed, frames):
    store = open_cells(bed.cells)
    single = frames.astype(np.float32).astype(float)
    column = np.minimum((single[:, 0] / (WIDTH / COLUMNS)).astype(int), COLUMNS - 1)
    row = np.minimum((single[:, 1] / (HEIGHT / ROWS)).astype(int), ROWS - 1)
    np.testing.assert_array_equal(store.cells, row * COLUMNS + column)
    np.testing.assert_allclose(store.times_s, TIMES)
    assert (store.grid.columns, store.grid.rows) == (COLUMNS, ROWS)


def test_cells_file_reads_with_numpy_alone(bed):
    with np.load(bed.cells) as content:
        np.testing.assert_array_equal(content["cells"], open_cells(bed.cells).cells)
        assert content["cells"].dtype == np.int32


def test_cells_smaller_than_a_particle_are_refused(bed, tmp_path):
    with pytest.raises(DataError, match="columns"):
        assign_cells(bed.files, tmp_path / "c.npz", Division(100, ROWS), DIAMETER)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("model", MODELS)
def test_transitions_keep_every_particle(bed, model):
    chain = registry.load(bed.transitions[model])
    np.testing.assert_allclose(chain.matrix.sum(axis=1), 1, atol=ROUND_OFF)
    assert chain.lag_s == pytest.approx(0.025)


def test_learning_window_outside_the_frames_writes_nothing(bed, tmp_path):
    with pytest.raises(DataError, match="9 s"):
        build_transitions(bed.files, tmp_path / "t.npz", "static", "pooled", 0.025, Window(0.5, 9.0))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("model", MODELS)
def test_chain_holds_curves_and_batches(bed, model):
    with np.load(bed.chains[model]) as chain:
        assert chain["remaining"].shape == chain["remaining_monte_carlo"].shape == (STEPS + 1, 4)
        np.testing.assert_array_equal(chain["remaining"][0], 1)
        np.testing.assert_allclose(chain["times_s"], COMPARE[0] + 0.025 * np.arange(STEPS + 1))
        for name in ("batch_share", "batch_share_monte_carlo"):
            assert chain[name].shape == (len(MOMENTS), COLUMNS * ROWS)
            np.testing.assert_allclose(chain[name].sum(axis=1), 1, atol=ROUND_OFF)


@pytest.mark.parametrize("model", MODELS)
def test_monte_carlo_agrees_with_the_exact_expectation(bed, model):
    with np.load(bed.chains[model]) as chain:
        exact, drawn = chain["remaining"], chain["remaining_monte_carlo"]
    # fewer than a quarter of the particles are in the smallest group; independent draws
    error = np.sqrt(np.maximum(exact * (1 - exact), 1e-4) / (NUMBER / 4))
    assert (np.abs(drawn - exact) < SIGMAS * error).all()


def test_the_same_seed_gives_the_same_chain(bed, tmp_path):
    for name in ("a", "b"):
        run_chain(
            bed.files, bed.transitions["static"], tmp_path / name,
            LEARN, COMPARE, SPLITS, Batch(BATCH, MOMENTS), ModelSettings("pooled", 3),
        )  # fmt: skip
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_moments_must_be_frames():
    assert moment_frames([0.05, 0.30, 1.05], 0.025) == [2, 12, 42]
    with pytest.raises(UserError, match=r"moments_s: 0.06 s is no multiple"):
        moment_frames([0.05, 0.06], 0.025)
    with pytest.raises(UserError, match="must rise"):
        moment_frames([0.30, 0.05], 0.025)


def test_mixing_table_is_long_with_the_named_columns(bed):
    table = pd.read_csv(bed.mixing)
    assert list(table.columns) == ["time_s", "source", "direction", "group", "fraction_remaining_1"]
    sources = ["dem", *(f"{model}{how}" for model in MODELS for how in ("", "_monte_carlo"))]
    assert list(dict.fromkeys(table["source"])) == sources
    assert set(zip(table["direction"], table["group"], strict=True)) == {
        ("radial", "left"), ("radial", "right"), ("axial", "low"), ("axial", "up")
    }  # fmt: skip
    assert len(table) == len(sources) * 4 * (STEPS + 1)
    assert table["fraction_remaining_1"].between(0, 1).all()


def test_dem_curves_are_counted_from_the_positions(bed, frames):
    table = pd.read_csv(bed.mixing).query("source == 'dem'").set_index(["group", "time_s"])
    first, last = (int(round(time / 0.025)) for time in COMPARE)
    x, z = (frames[first : last + 1, row].astype(np.float32) for row in (0, 1))
    x_m, z_m = SPLITS
    sides = {"left": x < x_m, "right": x >= x_m, "low": z < z_m, "up": z >= z_m}
    for group, on_side in sides.items():
        naive = [(on_side[0] & now).sum() / on_side[0].sum() for now in on_side]
        np.testing.assert_allclose(table.loc[group, "fraction_remaining_1"], naive, rtol=1e-7)


def test_chains_follow_the_rolls(bed):
    metrics = pd.read_csv(bed.metrics).set_index(["source", "quantity"])["value"]
    errors = {
        model: np.array([metrics[model, f"error_rms_{group}"] for group in ("left", "right", "low", "up")])
        for model in MODELS
    }
    assert errors["static"].max() < BLUR
    # where a particle comes from tells which way it is going
    assert (errors["dynamic"] < errors["static"]).all()
    assert metrics["dem", "particles"] == NUMBER


def test_metrics_of_the_bed_come_from_the_series(bed):
    metrics = pd.read_csv(bed.metrics)
    assert list(metrics.columns) == ["quantity", "source", "value", "unit", "ci_low", "ci_high"]
    row = metrics.set_index("quantity").loc["pressure_drop_over_weight"]
    assert row["value"] == pytest.approx(1, abs=MEAN_ERROR)
    assert row["ci_low"] < row["value"] < row["ci_high"]
    # five blocks know the error to a third, and their band is 2.8 errors wide
    assert row["ci_high"] - row["ci_low"] < 4 * MEAN_ERROR
    assert metrics.set_index("quantity").loc["particle_height_mean", "value"] == pytest.approx(FILLED / 2)


def test_errors_in_metrics_are_those_of_the_curves(bed):
    metrics = pd.read_csv(bed.metrics).set_index(["source", "quantity"])["value"]
    wide = pd.read_csv(bed.mixing).pivot_table("fraction_remaining_1", ["group", "time_s"], "source")
    # all are 1 at the start, which does not count
    wide = wide[wide.index.get_level_values("time_s") > COMPARE.start_s]
    error = (wide["static"] - wide["dem"]).groupby("group")
    assert metrics["static", "error_signed_up"] == pytest.approx(error.mean()["up"], rel=1e-5)
    rms = np.sqrt((error.get_group("up") ** 2).mean())
    assert metrics["static", "error_rms_up"] == pytest.approx(rms, rel=1e-5)


def test_series_without_a_column_is_refused(bed, tmp_path):
    (tmp_path / "s.csv").write_text("time_s,pressure_drop_Pa\n0,1\n")
    with pytest.raises(UserError, match="no column mean_height_m"):
        compare_mixing(
            bed.files, bed.chain_files, SolverSeries(tmp_path / "s.csv", LEARN, WEIGHT_PA), [],
            Tables(tmp_path / "mixing.csv", tmp_path / "metrics.csv"), COMPARE, SPLITS, BATCH,
        )  # fmt: skip
    assert not (tmp_path / "mixing.csv").exists()


def test_a_window_of_half_a_turn_of_the_rolls_is_too_short_for_error_bars(bed):
    metrics = pd.read_csv(bed.metrics).set_index(["source", "quantity"])
    for model in MODELS:
        with np.load(bed.chains[model]) as chain:
            assert chain["remaining_left_out"].shape == (0, STEPS + 1, 4)
        assert metrics.loc[(model, "crossed_end_left"), ["ci_low", "ci_high"]].isna().all()
    assert metrics.loc[("static_monte_carlo", "crossed_end_left"), ["ci_low", "ci_high"]].isna().all()


def test_error_bars_come_from_chains_learned_without_a_block(bed, tmp_path, monkeypatch):
    monkeypatch.setattr(bands, "FEWEST_CORRELATION_TIMES", 0)
    run_chain(
        bed.files, bed.transitions["static"], tmp_path / "chain.npz", LEARN, COMPARE, SPLITS,
        Batch(BATCH, MOMENTS), ModelSettings("pooled", 3),
    )  # fmt: skip
    with np.load(tmp_path / "chain.npz") as chain:
        left_out, shares, curves = (
            chain[name] for name in ("remaining_left_out", "batch_share_left_out", "remaining")
        )
    assert left_out.shape == (5, STEPS + 1, 4) and shares.sum(axis=2) == pytest.approx(1)
    low, high = bands.block_band(curves, left_out, "share")
    # the rolls turn alike at all times, so the chain itself is known well
    assert ((low < curves) & (curves < high))[1:].all() and (high - low).max() < 0.1


def test_error_bars_of_a_long_lag_are_there_before_its_first_step(bed, tmp_path, monkeypatch):
    monkeypatch.setattr(bands, "FEWEST_CORRELATION_TIMES", 0)
    transitions, lag = tmp_path / "transitions.npz", 4
    build_transitions(bed.files, transitions, "static", "pooled", lag * 0.025, LEARN)
    run_chain(
        bed.files, transitions, tmp_path / "chain.npz", LEARN, COMPARE, SPLITS,
        Batch(BATCH, MOMENTS), ModelSettings("pooled", 3),
    )  # fmt: skip
    with np.load(tmp_path / "chain.npz") as chain:
        spread = np.ptp(chain["remaining_left_out"], axis=0)
    assert (spread[1:] > 0).all() and (spread[0] == 0).all()
