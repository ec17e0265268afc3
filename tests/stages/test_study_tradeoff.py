# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade-off study on walkers whose velocity forgets itself in a known time."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import yaml

import study_tradeoff as stage
from bedchain.case.load import load_case
from bedchain.case.variants import Variant
from bedchain.errors import UserError
from bedchain.measures.mixing import Splits
from bedchain.studies.tradeoff import chain_settings, measured_chains, simulated_beds
from bedchain.studies.tradeoff.bed_variants import BedVariant
from bedchain.studies.tradeoff.observables import bed_errors
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from made.drawings import assert_drawn, outputs
from made.persistent_walk import write, write_bed
from made.synthetic_bed import write_run, write_series
from measure_mixing import measure_mixing
from plot_tradeoff import plot_tradeoff
from plot_variants import plot_variants

SIZE, NUMBER, FRAMES = 0.1, 3000, 141
MEMORY_S, SPEED = 0.2, 0.15
REPEATS = 2
PRESSURE, HEIGHT = 700.0, 0.05
CASE = {
    "title": "walkers", "seed": 10007, "bed": {"width_m": SIZE, "height_m": SIZE},
    "particles": {"number": NUMBER}, "time": {"end_s": 3.5},
    "learning": {"start_s": 0.25, "end_s": 2.0},
    "comparison": {"start_s": 2.0, "end_s": 3.5, "repeats": REPEATS},
    "cells": {"columns": 10, "rows": 10}, "mixing": {"split_z_m": SIZE / 2}, "chain": {"lag_s": 0.025},
}  # fmt: skip
TRACERS, CELLS_M, LAGS_S = (100, 10_000), (0.01, 0.02), (0.025, 0.1, 0.4, 1.0, 2.0)
COSTS = ["learn_s", "run_s", "cost_s", "preset"]


def write_walkers(folder):
    """A run of walkers with all that a case leaves behind, and its repeats."""
    for number in range(REPEATS + 1):
        path = folder / "repeats" / str(number) if number else folder
        write_bed(path, FRAMES, NUMBER, SIZE, MEMORY_S, SPEED, seed=number)
        write_series(path, np.arange(0, 3.5, 5e-3), PRESSURE * (1 + 0.01 * number), HEIGHT, NUMBER)
    # marked at the same time, which is all that the curves of independent walkers know
    for number in range(1, REPEATS + 1):
        path = folder / "repeats" / str(number)
        files = BedFiles(path / "trajectory.npy", path / "trajectory.json")
        splits = Splits(SIZE / 2, SIZE / 2)
        measure_mixing(files, path / "mixing.csv", f"dem_{number}", Window(2.0, 3.5), splits)
    (folder / "case.yaml").write_text(yaml.safe_dump(CASE))


@pytest.fixture(scope="module")
def fewer():
    """Fewer settings than the study's own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chain_settings, "TRACERS", TRACERS)
        patch.setattr(chain_settings, "CELL_SIZES_M", CELLS_M)
        patch.setattr(chain_settings, "LAGS_S", LAGS_S)
        yield


@pytest.fixture(scope="module")
def walkers(tmp_path_factory, fewer):
    """A finished study."""
    folder = tmp_path_factory.mktemp("walkers")
    write_walkers(folder)
    stage.study_tradeoff(folder / "case.yaml", folder, [])
    table = read(folder)
    return SimpleNamespace(folder=folder, case=folder / "case.yaml", table=table)


def read(folder):
    """The table, empty texts as such."""
    table = pd.read_csv(folder / "tradeoff.csv", dtype={"problem": str, "preset": str})
    return table.fillna({"problem": "", "preset": ""})


def row(table, **labels):
    for name, value in labels.items():
        table = table[np.isclose(table[name], value) if isinstance(value, float) else table[name] == value]
    assert len(table) == 1
    return table.iloc[0]


def test_each_setting_is_a_row_with_cost_and_errors_in_floors(walkers):
    table = walkers.table
    assert (table["problem"] == "").all() and (table["half"] == "mcm").all()
    assert set(table["axis"]) == {
        *("cells and lag", "cell shape", "estimator", "window", "window start", "order", "tracers"),
    }  # fmt: skip
    assert (table[["learn_s", "run_s", "memory_mb"]] > 0).all().all()
    for name in ("left", "right", "low", "up", "mixing", "density"):
        assert (table[f"{name}_ci_low_1"] <= table[f"{name}_ci_high_1"]).all()
        assert (table[f"{name}_floors_1"] > 0).all()
    # of shares of half of the walkers, half of which are left in the end: binomial at most
    floor = (table["mixing_error_1"] / table["mixing_floors_1"]).iloc[0]
    assert 0.3 < floor / np.sqrt(0.25 / (NUMBER / 2)) < 1.5


def test_who_forgets_the_velocity_needs_long_steps_and_who_knows_it_is_chosen(walkers):
    own = walkers.table.query("axis == 'cells and lag'")
    own = own[np.isclose(own["cell_width_m"], 0.01)]
    short, long = (row(own, lag_s=lag_s) for lag_s in (0.025, 0.4))
    assert long["validation_error_1"] < 0.5 * short["validation_error_1"]
    assert long["mixing_ci_high_1"] < short["mixing_ci_low_1"]
    presets = yaml.safe_load((walkers.folder / "presets.yaml").read_text())
    assert set(presets) == {"fast", "balanced", "accurate"}
    assert presets["accurate"]["model"] == "dynamic"
    accurate = walkers.table[walkers.table["preset"].str.contains("accurate")].iloc[0]
    assert presets["accurate"]["error_floors"] == pytest.approx(accurate["mixing_floors_1"], rel=0.01)
    valid = walkers.table.query("axis in ('cells and lag', 'order')")["validation_error_1"]
    assert accurate["validation_error_1"] == valid.min()
    assert accurate["mixing_error_1"] < long["mixing_error_1"]


def test_a_lag_that_cannot_be_validated_is_tested_all_the_same(walkers):
    table = walkers.table.query("axis == 'cells and lag' and lag_s > 0.9")
    assert len(table) and table["validation_error_1"].isna().all() and table["mixing_error_1"].notna().all()
    assert 2.0 not in set(walkers.table["lag_s"])


def test_more_tracers_come_nearer_to_the_exact_chain(walkers):
    table = walkers.table
    exact = row(table.query("axis == 'cells and lag'"), cell_width_m=0.01, cell_height_m=0.01, lag_s=0.025)
    few, many = (row(table, axis="tracers", tracers=number) for number in TRACERS)
    apart = [abs(one["mixing_error_1"] - exact["mixing_error_1"]) for one in (few, many)]
    assert apart[1] < apart[0] and apart[1] < 0.02
    # the density of few tracers is their shot noise
    assert few["density_error_1"] > 3 * many["density_error_1"] > 3 * exact["density_error_1"]


def test_a_longer_window_learns_better(walkers):
    table = walkers.table
    half = row(table.query("axis == 'window'"), learning_start_s=1.5)
    exact = row(table.query("axis == 'cells and lag'"), cell_width_m=0.01, cell_height_m=0.01, lag_s=0.025)
    assert exact["density_error_1"] < half["density_error_1"]


def test_a_stopped_study_goes_on_where_it_was(walkers, monkeypatch):
    before = walkers.table.drop(columns=COSTS)
    (walkers.folder / "tradeoff.csv").unlink()
    kept = sorted((walkers.folder / "tradeoff" / "settings").rglob("*.json"))
    assert len(kept) == len(before)
    kept[3].unlink()
    again, real = [], measured_chains.measured
    monkeypatch.setattr(measured_chains, "measured", lambda *a: again.append(a[0]) or real(*a))
    stage.study_tradeoff(walkers.case, walkers.folder, [])
    assert len(again) == 1
    after = read(walkers.folder)
    pd.testing.assert_frame_equal(after.drop(columns=COSTS), before, rtol=1e-6)


def test_scrambling_the_comparison_leaves_the_validation_alone(walkers, tmp_path, monkeypatch):
    monkeypatch.setattr(chain_settings, "TRACERS", ())
    write_walkers(tmp_path)
    values = np.load(tmp_path / "trajectory.npy")
    after = round(2.0 / 0.025) + 1
    values[after:] = np.random.default_rng(9).permuted(values[after:], axis=2)
    write(tmp_path, values, SIZE)
    stage.study_tradeoff(tmp_path / "case.yaml", tmp_path, [])
    found, wanted = (
        table[table["tracers"] == 0] for table in (pd.read_csv(tmp_path / "tradeoff.csv"), walkers.table)
    )
    columns = ["variant", "validation_error_1"]
    pd.testing.assert_frame_equal(
        found[columns].reset_index(drop=True), wanted[columns].reset_index(drop=True), rtol=1e-6
    )
    assert not np.allclose(found["mixing_error_1"], wanted["mixing_error_1"], rtol=0.01)


def test_a_bed_is_measured_against_all_realisations(walkers, tmp_path):
    case = load_case(walkers.case)
    bench, _ = stage.opened(case, walkers.folder)
    values = np.load(walkers.folder / "trajectory.npy").astype(float)
    write_run(tmp_path, values, np.arange(FRAMES) * 0.025, SIZE, SIZE)
    write_series(tmp_path, np.arange(0, 3.5, 5e-3), 2 * PRESSURE, HEIGHT, NUMBER)
    found = bed_errors(bench.reference, simulated_beds.bed_observables(tmp_path, case))
    assert not (tmp_path / "trajectory.npy").exists()
    # three realisations, one of which it is: two thirds of the squares of two differences
    assert found["mixing_floors_1"] == pytest.approx(np.sqrt(4 / 3), rel=0.25)
    for name in ("mixing_time_radial", "dispersion_x", "granular_temperature"):
        known = np.array(bench.reference.scalars[name])
        column = next(one for one in found if one.startswith(f"{name}_error"))
        assert found[column] == pytest.approx(known[0] - known.mean(), rel=1e-3)
        assert abs(found[f"{name}_floors_1"]) <= 2
    assert found["pressure_drop_error_Pa"] == pytest.approx(0.99 * PRESSURE, rel=0.02)
    assert found["pressure_drop_floors_1"] == pytest.approx(0.99 / 0.01, rel=0.02)
    # free walkers have the speed that they were made with, in either direction, about the mean of a cell
    assert bench.reference.scalars["granular_temperature"][0] == pytest.approx(SPEED**2, rel=0.05)


def test_without_repeats_the_floor_is_empty_and_said(walkers, tmp_path, caplog, monkeypatch):
    monkeypatch.setattr(chain_settings, "TRACERS", ())
    monkeypatch.setattr(chain_settings, "LAGS_S", (0.1,))
    write_walkers(tmp_path)
    case = CASE | {"comparison": CASE["comparison"] | {"repeats": 0}}
    (tmp_path / "case.yaml").write_text(yaml.safe_dump(case))
    with caplog.at_level("INFO", "bedchain"):
        stage.study_tradeoff(tmp_path / "case.yaml", tmp_path, [])
    assert "no repeats, so no noise floor" in caplog.text
    table = pd.read_csv(tmp_path / "tradeoff.csv")
    assert table["mixing_floors_1"].isna().all() and table["mixing_error_1"].notna().all()
    assert table["density_floors_1"].notna().all()
    presets = yaml.safe_load((tmp_path / "presets.yaml").read_text())
    assert presets["fast"]["error_floors"] is None
    plot_tradeoff(tmp_path / "tradeoff.csv", outputs(tmp_path / "f", "p"))
    assert set(assert_drawn(tmp_path / "f", "p")["unit"]) == {"share"}


def test_a_variant_that_does_not_exist_is_told_the_others(walkers):
    with pytest.raises(UserError, match=r"no variant friktion: take of .*friction_0"):
        stage.study_tradeoff(walkers.case, walkers.folder, ["friktion"])


def test_figures_of_the_study_are_drawn(walkers, tmp_path):
    plot_tradeoff(walkers.folder / "tradeoff.csv", outputs(tmp_path / "a", "a"))
    drawn = assert_drawn(tmp_path / "a", "a")
    assert len(drawn) == len(walkers.table) and (drawn["own"] == 1).sum() == 1
    assert drawn["mixing_error"].to_numpy() == pytest.approx(walkers.table["mixing_floors_1"].to_numpy())
    with pytest.raises(UserError, match="holds no simulated bed"):
        plot_variants(walkers.folder / "tradeoff.csv", outputs(tmp_path / "b", "b"))
    case = load_case(walkers.case)
    bench, _ = stage.opened(case, walkers.folder)
    bad = BedVariant("ablation", Variant("bad", {"time.dem_step_s": 1e-4}))
    simulated_beds.simulate_bed(walkers.case, bad, tmp_path / "bad")
    rows = simulated_beds.measure_all([bad], tmp_path, bench.reference)
    for name, cost_s in (("base", 100.0), ("friction_0", 80.0)):
        values = np.load(walkers.folder / "repeats" / "1" / "trajectory.npy").astype(float)
        (tmp_path / name).mkdir()
        write_run(tmp_path / name, values, np.arange(FRAMES) * 0.025, SIZE, SIZE)
        write_series(tmp_path / name, np.arange(0, 3.5, 5e-3), PRESSURE, HEIGHT, NUMBER)
        labels = {"half": "dem", "axis": "realisation" if name == "base" else "ablation", "variant": name}
        errors = bed_errors(bench.reference, simulated_beds.bed_observables(tmp_path / name, case))
        rows.append(labels | {"cost_s": cost_s} | errors)
    pd.concat([walkers.table.replace("", np.nan), pd.DataFrame(rows)]).to_csv(tmp_path / "t.csv", index=False)
    plot_variants(tmp_path / "t.csv", outputs(tmp_path / "b", "b"))
    drawn = assert_drawn(tmp_path / "b", "b").set_index("variant")
    assert drawn["cost_over_base_1"]["friction_0"] == pytest.approx(0.8)
    assert "Rayleigh" in drawn["problem"]["bad"] and drawn["mixing_floors_1"]["base"] > 0
