# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing and testing models on walkers whose velocity forgets itself in a known time."""

import shutil
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import score_models as stage
from bedchain.errors import UserError
from bedchain.measures.batch import Batch
from bedchain.measures.mixing import Splits
from bedchain.studies.candidates import Candidate
from bedchain.studies.scores import selection
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from made.drawings import assert_drawn, outputs
from made.persistent_walk import squared, write, write_bed
from plot_autocorrelation import plot_autocorrelation
from plot_best_mixing import plot_best_mixing
from plot_pareto import plot_pareto

SIZE, NUMBER, FRAMES = 0.1, 3000, 141
MEMORY_S, SPEED = 0.2, 0.15
LEARNING, COMPARISON = Window(0.25, 1.75), Window(1.75, 3.25)
MOMENTS = [0.05, 0.3, 0.55]
TRIED = [
    Candidate("static", 10, 10, 1),
    Candidate("static", 10, 10, 6),
    Candidate("velocity_class", 10, 10, 1, {"classes": [5, 5]}),
]
TIMES = ["learn_s", "curves_s", "paths_s"]


def scored(folder, trajectory, repeats=(), tried=None):
    """Paths of what score_models makes of a bed."""
    names = {
        "scores": "scores.csv", "selection": "selection.csv", "mixing": "scores_mixing.csv",
        "lagrangian": "scores_lagrangian.csv", "best": "scores_best.npz",
    }  # fmt: skip
    paths = SimpleNamespace(**{key: folder / name for key, name in names.items()})
    stage.score_models(
        BedFiles(trajectory, trajectory.with_suffix(".json")), list(repeats),
        stage.ScoreFiles(**vars(paths)), LEARNING, COMPARISON,
        stage.Observed(Splits(SIZE / 2, SIZE / 2), Batch(0.03, MOMENTS)),
        stage.ScoredChains(10, 10, 0.025, "pooled", 5, 1e-3), TRIED if tried is None else tried,
    )  # fmt: skip
    return paths


@pytest.fixture(scope="module")
def walkers(tmp_path_factory):
    """A bed of walkers, two repeats of it, and its scores."""
    folder = tmp_path_factory.mktemp("walkers")
    trajectories = [
        write_bed(folder / name, FRAMES, NUMBER, SIZE, MEMORY_S, SPEED, seed)
        for seed, name in enumerate(("run", "repeats/1", "repeats/2"))
    ]
    paths = scored(folder / "scores", trajectories[0], trajectories[1:])
    return SimpleNamespace(trajectories=trajectories, **vars(paths))


@pytest.fixture(scope="module")
def table(walkers):
    return pd.read_csv(walkers.scores).fillna({"options": ""})


def score(table, quantity, model, window, lag_s=0.025, time_s=np.nan):
    """The one row of a score."""
    rows = table.query("quantity == @quantity and model == @model and window == @window")
    rows = rows[rows["time_s"].isna() if np.isnan(time_s) else np.isclose(rows["time_s"], time_s)]
    rows = rows if model == "dem" else rows[np.isclose(rows["lag_s"], lag_s)]
    assert len(rows) == 1
    return rows.iloc[0]


def test_the_model_that_knows_the_velocity_is_chosen_and_wins(walkers, table):
    chosen = pd.read_csv(walkers.selection).query("best == 1")
    assert chosen["model"].item() == "velocity_class"
    for side in ("radial", "axial"):
        static, better = (
            score(table, f"error_rms_{side}", model, "starts") for model in ("static", "velocity_class")
        )
        assert better["value"] < 0.5 * static["value"]
        assert better["ci_high"] < static["ci_low"]
        # without its velocity a particle turns back at each step: too slow
        assert score(table, f"error_signed_{side}", "static", "starts")["ci_low"] > 0


def test_each_model_has_one_setting_and_the_papers_chain_is_always_tested(walkers, table):
    chosen = pd.read_csv(walkers.selection).query("chosen == 1")
    assert sorted(chosen["model"]) == ["static", "velocity_class"]
    assert chosen.set_index("model")["lag_s"]["static"] == pytest.approx(0.15)
    tested = table.query("quantity == 'error_rms_mixing' and window == 'start'")
    settings = {(row.model, round(row.lag_s, 3)) for row in tested.itertuples() if np.isnan(row.time_s)}
    by_rule = [lag_s for model, lag_s in settings if model == "chosen"]
    # walkers forget their velocity in 0.2 s; only walls stop them: the rule takes at least that
    assert len(by_rule) == 1 and 0.2 <= by_rule[0] <= 0.75
    assert settings == {("static", 0.025), ("static", 0.15), ("velocity_class", 0.025), ("chosen", *by_rule)}


def test_scrambling_the_test_window_leaves_the_choice_alone(walkers, tmp_path):
    values = np.load(walkers.trajectories[0])
    after = round(LEARNING.end_s / 0.025) + 1
    rng = np.random.default_rng(9)
    values[after:] = rng.permuted(values[after:], axis=2)
    again = scored(tmp_path / "a", write(tmp_path / "scrambled", values, SIZE))
    kept = pd.read_csv(walkers.selection).drop(columns=TIMES)
    pd.testing.assert_frame_equal(pd.read_csv(again.selection).drop(columns=TIMES), kept)
    assert not pd.read_csv(again.scores)["value"].equals(pd.read_csv(walkers.scores)["value"])
    values[after - 20 : after] = rng.permuted(values[after - 20 : after], axis=2)
    other = scored(tmp_path / "b", write(tmp_path / "scrambled", values, SIZE), tried=TRIED[:1])
    error = pd.read_csv(other.selection)["validation_rms"].item()
    assert (np.abs(error - kept["validation_rms"]) > 1e-3).all()


def test_displacements_are_those_of_theory_and_memory_is_seen(table):
    found = score(table, "msd_x", "dem", "start", time_s=0.1)
    # walls turn back the walkers that come from within 1.4 cm of them, a seventh of all at each of two walls
    assert 0.8 < found["value"] / squared(0.1, MEMORY_S, SPEED) < 1.0
    memory = score(table, "autocorrelation_x", "velocity_class", "start", time_s=0.1)
    static = score(table, "autocorrelation_x", "static", "start", time_s=0.1)
    dem = score(table, "autocorrelation_x", "dem", "start", time_s=0.1)
    assert abs(memory["value"] - dem["value"]) < 0.3 * abs(static["value"] - dem["value"])
    slow = score(table, "dispersion_error_signed_x", "static", "start", time_s=0.1)
    assert slow["value"] < -0.2


def test_noise_floor_is_that_of_independent_particles(table):
    # half of the particles are marked, and about half of them are left after long: binomial
    floor = score(table, "error_rms_mixing", "velocity_class", "start")["noise_floor"]
    assert 0.3 < floor / np.sqrt(0.25 / (NUMBER / 2)) < 1.5
    # walkers are independent: their starts differ by no more than their repeats do
    assert score(table, "spread_of_starts_mixing", "dem", "starts")["value"] == pytest.approx(floor, rel=0.5)


def test_identical_repeats_have_no_noise_floor(walkers, tmp_path):
    first = walkers.trajectories[0]
    for name in ("trajectory.npy", "trajectory.json"):
        (tmp_path / "1").mkdir(exist_ok=True)
        shutil.copy(first.parent / name, tmp_path / "1" / name)
    paths = scored(tmp_path / "s", first, [tmp_path / "1" / "trajectory.npy"], TRIED[:1])
    table = pd.read_csv(paths.scores)
    floors = table[table["quantity"].str.startswith(("error_", "batch_", "msd_", "dispersion_"))][
        "noise_floor"
    ]
    assert len(floors) > 100 and floors.abs().max() < 1e-9
    one, other = (
        score(table, "error_rms_mixing", "static", window)["value"] for window in ("start", "repeats")
    )
    assert one == pytest.approx(other)


def test_errors_are_those_of_the_curves_in_the_table(walkers, table):
    curves = pd.read_csv(walkers.mixing).pivot_table("fraction_remaining_1", ["group", "time_s"], "source")
    error = (curves["velocity_class"] - curves["dem"]).loc["left"].to_numpy()[1:]
    found = score(table, "error_rms_left", "velocity_class", "start")
    assert found["value"] == pytest.approx(np.sqrt((error**2).mean()), rel=1e-4)
    at_half = score(table, "error_signed_left", "velocity_class", "start", time_s=0.5)
    assert at_half["value"] == pytest.approx(error[19], abs=1e-6)
    assert np.isnan(found["ci_low"]) and not np.isnan(
        score(table, "error_rms_left", "static", "starts")["ci_low"]
    )


def test_batches_and_their_files_are_shares(walkers, table):
    with np.load(walkers.best) as best:
        assert str(best["model"]) == "velocity_class"
        assert best["batch_share"].shape == (3, 100)
        assert best["batch_share"].sum(axis=1) == pytest.approx([1, 1, 1])
        assert best["batch_share_monte_carlo"].sum(axis=1) == pytest.approx([1, 1, 1])
    found = score(table, "batch_total_variation", "velocity_class", "starts")
    assert 0 < found["value"] < score(table, "batch_total_variation", "static", "starts")["value"]


def test_results_are_kept_and_taken_up_again(walkers, tmp_path, monkeypatch):
    first, done = walkers.trajectories[0], []
    real = selection.validated

    def stops_at_the_second(*arguments):
        if done:
            raise KeyboardInterrupt
        done.append(arguments[0])
        return real(*arguments)

    monkeypatch.setattr(selection, "validated", stops_at_the_second)
    with pytest.raises(KeyboardInterrupt):
        scored(tmp_path, first)
    again = []
    monkeypatch.setattr(selection, "validated", lambda *a: again.append(a[0]) or real(*a))
    paths = scored(tmp_path, first)
    assert done == TRIED[:1] and again == TRIED[1:]
    found, wanted = (pd.read_csv(path).drop(columns=TIMES) for path in (paths.selection, walkers.selection))
    pd.testing.assert_frame_equal(found, wanted)


def test_a_lag_too_long_to_validate_is_said_and_left_out(walkers, tmp_path):
    tried = [*TRIED[:1], Candidate("static", 10, 10, 24), Candidate("dynamic", 10, 10, 24)]
    paths = scored(tmp_path, walkers.trajectories[0], tried=tried)
    table = pd.read_csv(paths.selection)
    assert table["problem"].iloc[1].startswith("lag 0.6 s is longer than the")
    assert set(table.query("chosen == 1")["model"]) == {"static"}
    with pytest.raises(UserError, match="no model could be validated: lag 0.6 s"):
        scored(tmp_path / "none", walkers.trajectories[0], tried=tried[1:])
    assert not (tmp_path / "none" / "scores.csv").exists()


def test_a_bed_without_velocities_is_scored_from_differences(walkers, tmp_path):
    values = np.load(walkers.trajectories[0])
    values[:, 2:] = np.nan
    paths = scored(tmp_path, write(tmp_path / "run", values, SIZE))
    found = pd.read_csv(paths.selection).set_index(["model", "lag_s"])["validation_rms"]
    assert found["velocity_class", 0.025] < 0.7 * found["static", 0.025]
    reported = pd.read_csv(paths.scores).query("quantity == 'learned_velocities_from_differences'")
    assert reported["value"].tolist() == [1]


def test_figures_of_the_scores_are_drawn(walkers, tmp_path):
    plot_pareto(walkers.scores, walkers.selection, outputs(tmp_path, "p"), 0.01, 0.025)
    pareto = assert_drawn(tmp_path, "p")
    assert len(pareto) == 3 + 2 * 4 and (pareto["cost_s"] > 0).all()
    assert set(pareto["source"]) == {"static", "static_baseline", "velocity_class", "chosen"}
    plot_best_mixing(walkers.mixing, walkers.selection, outputs(tmp_path, "b"), "#222222", "#ee6677")
    curves = assert_drawn(tmp_path, "b")
    assert {"dem", "dem_1", "dem_2", "static_baseline", "velocity_class"} < set(curves["source"])
    plot_autocorrelation(walkers.lagrangian, outputs(tmp_path, "a"), "#222222")
    lines = assert_drawn(tmp_path, "a").query("time_s == 0")
    assert lines["autocorrelation_1"].to_numpy() == pytest.approx(1.0)
    with pytest.raises(UserError, match="lacks the DEM"):
        pd.read_csv(walkers.lagrangian).query("source != 'dem'").to_csv(tmp_path / "l.csv")
        plot_autocorrelation(tmp_path / "l.csv", outputs(tmp_path, "x"), "#222222")
