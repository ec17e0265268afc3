# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostics of a bed that is Markov by construction, with every answer known; and figures of them."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from assign_cells import Division, assign_cells
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.diagnostics import COLUMNS as HEADER
from bedchain.errors import UserError
from bedchain.measures.mixing import GROUPS, Splits
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from build_transitions import build_transitions
from diagnose_chains import diagnose_chains
from made.drawings import COLOURS, assert_drawn, outputs
from made.small_bed import COLUMNS, MODELS, MOMENTS, ROWS, SPLITS
from made.small_bed import COMPARE as COMPARE_OF_BED
from made.synthetic_bed import write_run
from parse_dumps import parse_dumps
from plot_chapman_kolmogorov import plot_chapman_kolmogorov
from plot_difference import plot_difference
from plot_modes import plot_modes
from plot_timescales import plot_timescales, processes

# 6 x 4 cells of 1 cm; along each axis a particle stays with 1/2 and moves with 1/4 each way, as walls allow
ACROSS, UP, SIZE, LAG = 6, 4, 0.01, 0.025
WALKERS, FRAMES = 2000, 121
LEARN, COMPARE = Window(0.5, 2.0), Window(2.0, 3.0)
LAGS = [1, 2, 4, 8]
# 120 000 moves learned from: a percent on a probability; the gap of the slowest process is a difference
SAMPLING = 0.08
# four standard errors of the share of 1000 particles that take 60 steps in common
SHARE_ERROR = 0.03


def eigenvalue(n):
    """Second eigenvalue of the lazy reflecting walk on n cells."""
    return 1 - (1 - np.cos(np.pi / n)) / 2


@pytest.fixture(scope="session")
def walk(tmp_path_factory):
    """Diagnostics of the walkers, by quantity, source, lag and part; and the path of the table."""
    folder, rng = tmp_path_factory.mktemp("walk"), np.random.default_rng(5)
    place = np.array([rng.integers(0, n, WALKERS) for n in (ACROSS, UP)])
    frames, upper = [], np.array([[ACROSS - 1], [UP - 1]])
    for _ in range(FRAMES):
        x, z = (place + 0.5) * SIZE
        frames.append(np.array([x, z, 0 * x, 0 * x]))
        place = np.clip(place + rng.choice([-1, 0, 0, 1], place.shape), 0, upper)
    files = BedFiles(*(folder / name for name in ("trajectory.npy", "trajectory.json", "cells.npz")))
    times = np.round(np.arange(FRAMES) * LAG, 6)
    dem = write_run(folder, np.array(frames), times, ACROSS * SIZE, UP * SIZE)
    parse_dumps(dem, files.trajectory, files.metadata, ACROSS * SIZE, UP * SIZE, progress=False)
    assign_cells(files, files.cells, Division(ACROSS, UP), 1e-3)
    transitions = {model: folder / f"transitions_{model}.npz" for model in MODELS}
    for model, path in transitions.items():
        build_transitions(files, path, model, "pooled", LAG, LEARN)
    path = folder / "diagnostics.csv"
    diagnose_chains(
        files,
        list(transitions.values()),
        path,
        folder / "modes.csv",
        LEARN,
        COMPARE,
        Splits(0.03, 0.02),
        ModelSettings("pooled", 3),
    )
    return SimpleNamespace(path=path, table=pd.read_csv(path), modes=folder / "modes.csv", files=files)


def value(walk, quantity, source, **where):
    """The one value of a quantity."""
    rows = walk.table[(walk.table["quantity"] == quantity) & (walk.table["source"] == source)]
    for column, wanted in where.items():
        rows = rows[rows[column] == wanted]
    assert len(rows) == 1
    return rows["value"].item()


def test_the_table_has_its_columns_units_and_no_gaps(walk):
    assert list(walk.table.columns) == list(HEADER)
    assert walk.table[["quantity", "source", "value", "unit"]].notna().all().all()
    assert set(walk.table["unit"]) == {"1", "s", "m2/s", "1/s"}
    assert not walk.table.duplicated(list(HEADER[:6])).any()


@pytest.mark.parametrize("model", MODELS)
def test_timescales_are_level_and_those_of_the_walk(walk, model):
    expected = -LAG / np.log(eigenvalue(ACROSS))
    for lag in LAGS:
        found = value(walk, "implied_timescale", model, lag_s=lag * LAG, part="1")
        assert found == pytest.approx(expected, rel=SAMPLING)
    assert value(walk, "mixing_time", model) == pytest.approx(LAG / (1 - eigenvalue(ACROSS)), rel=SAMPLING)


@pytest.mark.parametrize("model", MODELS)
def test_residence_and_passage_are_those_of_the_walk(walk, model):
    # stays with 1/2 in each direction, at a wall with 3/4
    assert value(walk, "residence_time", model, part="shortest") == pytest.approx(LAG / 0.75, rel=SAMPLING)
    corner = LAG / (1 - 0.75**2)
    assert value(walk, "residence_time", model, part="longest") == pytest.approx(corner, rel=SAMPLING)
    # from the lowest of four rows to the highest: 2 k (k + 1) steps for k = 3
    assert value(walk, "first_passage_time", model) == pytest.approx(24 * LAG, rel=SAMPLING)
    share = value(walk, "first_passage_share", "dem")
    assert value(walk, "first_passage_share", model) == pytest.approx(share, abs=2 * SHARE_ERROR)
    rows = walk.table[walk.table["quantity"].isin(["first_passage_share", "lacey_index"])]
    own = rows[(rows["source"] == model) & rows["value"].between(1e-6, 1 - 1e-6)]
    assert len(own) > 2 and (own["ci_low"] <= own["value"]).all() and (own["value"] <= own["ci_high"]).all()
    assert rows[rows["source"] == "dem"]["ci_low"].isna().all()  # a single realisation


@pytest.mark.parametrize("source", ["dem", "dem_cells", *MODELS])
def test_dispersion_is_that_of_the_walk(walk, source):
    # mean square of a step: 1/2 inside, 1/4 in the two columns at the walls
    square = (4 * 0.5 + 2 * 0.25) / 6 * SIZE**2
    for height in (np.arange(UP) + 0.5) * SIZE:
        rows = walk.table.query("quantity == 'dispersion_x' and source == @source")
        rows = rows[np.isclose(rows["height_m"], height) & np.isclose(rows["lag_s"], LAG)]
        assert rows["value"].item() == pytest.approx(square / (2 * LAG), rel=SAMPLING)


@pytest.mark.parametrize("model", MODELS)
def test_chapman_kolmogorov_error_is_chance(walk, model):
    for _, group in GROUPS:
        for lag in LAGS:
            where = {"lag_s": lag * LAG, "part": group}
            assert value(walk, "chapman_kolmogorov_rms", model, **where) < SHARE_ERROR
            assert abs(value(walk, "chapman_kolmogorov_mean", model, **where)) < SHARE_ERROR


@pytest.mark.parametrize("lag", LAGS)
def test_one_step_of_the_static_chain_is_what_was_counted(walk, lag):
    for _, group in GROUPS:
        seen = value(walk, "remaining_counted", "dem", time_s=lag * LAG, part=group)
        step = value(walk, "remaining_propagated", "static", lag_s=lag * LAG, time_s=lag * LAG, part=group)
        assert step == pytest.approx(seen, abs=1e-7)


def test_estimators_agree_where_every_cell_is_always_occupied(walk):
    for estimator in ("literal", "per_step", "pooled"):
        assert value(walk, "row_sum_error", "static", part=estimator) < 1e-10
        assert value(walk, "leak", "static", part=estimator) == 0
        assert value(walk, "long_run_total_variation", "static", part=estimator) < SHARE_ERROR
    leak = [value(walk, "leak", "dynamic", part=name) for name in ("literal", "per_step", "pooled")]
    assert leak[0] >= 0 and leak[1:] == [0, 0]


@pytest.mark.parametrize("source", ["dem", *MODELS])
def test_lacey_index_rises_from_apart_to_mixed(walk, source):
    rows = walk.table.query("quantity == 'lacey_index' and source == @source").sort_values("time_s")
    for _, curve in rows.groupby("part"):
        assert curve["value"].iloc[0] == pytest.approx(0, abs=1e-9)
        assert curve["value"].iloc[-1] > 0.85
        assert curve["time_s"].iloc[-1] == pytest.approx(1.0)


def test_chapman_kolmogorov_figure_has_the_curves_of_all(walk, tmp_path):
    plot_chapman_kolmogorov(walk.path, outputs(tmp_path, "ck"), COLOURS)
    table = assert_drawn(tmp_path, "ck")
    assert set(table["source"]) == {"dem", *MODELS}
    assert set(table["group"]) == {group for _, group in GROUPS}
    assert table["fraction_remaining_1"].between(0, 1).all()


def test_timescales_figure_has_the_processes_of_all_lags(walk, tmp_path):
    plot_timescales(walk.path, outputs(tmp_path, "ts"), {m: COLOURS[m] for m in MODELS})
    table = assert_drawn(tmp_path, "ts")
    assert sorted(table["lag_s"].unique()) == pytest.approx([lag * LAG for lag in LAGS])
    assert (table["timescale_s"] > 0).all()


def test_a_pair_of_eigenvalues_is_one_process():
    rows = {"source": "static", "lag_s": 0.1, "part": [1, 2, 3, 4], "value": [0.5, 0.3, 0.3, 0.1]}
    found = processes(pd.DataFrame(rows).assign(ci_low=0.0, ci_high=1.0))
    assert found["timescale_s"].tolist() == [0.5, 0.3, 0.1]
    assert found["process"].tolist() == [1, 2, 3] and found["turns"].tolist() == [0, 1, 0]


def test_difference_figure_has_the_distance_of_each_moment(bed, tmp_path):
    chains = [bed.chains[model] for model in MODELS]
    plot_difference(bed.cells, *chains, outputs(tmp_path, "d"), COMPARE_OF_BED.start_s)
    table = assert_drawn(tmp_path, "d")
    assert len(table) == len(MOMENTS) * COLUMNS * ROWS
    for _, part in table.groupby("time_s"):
        assert part["difference_1"].sum() == pytest.approx(0, abs=1e-6)
        half = 0.5 * part["difference_1"].abs().sum()
        assert part["total_variation_1"].to_numpy() == pytest.approx(half, abs=1e-6)


def test_figures_of_models_without_rows_are_refused(walk, tmp_path):
    with pytest.raises(UserError, match="lacks timescales of other"):
        plot_timescales(walk.path, outputs(tmp_path, "ts"), {"other": "blue"})
    with pytest.raises(UserError, match="lacks curves of dem, static"):
        plot_chapman_kolmogorov(walk.path, outputs(tmp_path, "ck"), {"dem": "black", "static": "red"})
    assert list(tmp_path.iterdir()) == []


def test_modes_are_drawn_with_the_cosine_of_the_walk(walk, tmp_path):
    plot_modes(walk.modes, walk.files.cells, outputs(tmp_path, "modes"))
    table = assert_drawn(tmp_path, "modes")
    for model in MODELS:
        rows = table.query("source == @model and quantity == 'excess' and part == 1").sort_values("cell")
        across = rows["value"].to_numpy().reshape(UP, ACROSS).mean(axis=0)
        cosine = np.cos(np.pi * (np.arange(ACROSS) + 0.5) / ACROSS)
        assert abs(np.corrcoef(across, cosine)[0, 1]) > 0.98
        # nothing circulates: what is left is chance
        assert value(walk, "net_flux_share", model) < 3 * SAMPLING
        assert value(walk, "mode_held_share", model, part="1") > 0.5


def test_a_real_roll_is_not_followed_by_the_static_chain_of_short_steps(bed, tmp_path):
    path = tmp_path / "diagnostics.csv"
    diagnose_chains(
        bed.files, list(bed.transitions.values()), path, tmp_path / "modes.csv", LEARN, COMPARE, SPLITS,
        ModelSettings("pooled", 3),
    )  # fmt: skip
    table = pd.read_csv(path).query("quantity == 'chapman_kolmogorov_rms' and part == 'low'")
    error = table.set_index(["source", "lag_s"])["value"]
    # cells of 1 cm blur the rolls at each step: the more steps, the worse; the dynamic chain blurs less
    assert error["static", 0.025] > 1.5 * error["static", 0.2]
    assert error["static", 0.025] > error["dynamic", 0.025]
