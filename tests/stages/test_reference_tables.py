# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeats, discussion and stationarity of a small bed of known motion."""

import imageio_ffmpeg
import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.errors import UserError
from bedchain.figures.style import FigureFiles
from bedchain.measures.voidage import Slab
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from compare_mixing import SolverSeries, Tables, compare_mixing
from discuss_errors import CaseChains, Scanned, discuss_errors
from made import ROOT
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    HEIGHT,
    LEARN,
    MODELS,
    NUMBER,
    ROWS,
    SPLITS,
    WEIGHT_PA,
    WIDTH,
)
from made.synthetic_bed import rolling_bed, write_run
from make_film import Halves, make_film
from measure_mixing import measure_mixing
from parse_dumps import parse_dumps
from plot_bubbles import plot_bubbles
from plot_discussion import plot_discussion
from plot_mixing import plot_mixing
from plot_stationarity import plot_stationarity

GROUPS = ("left", "right", "low", "up")
DPI = 60
LAG = 0.025
COLOURS = {"dem": "#222222", "static": "#ee6677", "dynamic": "#4477aa"}
SIZES, LAGS = [0.01, 0.02, 0.04], [0.025, 0.1, 0.3]


def forms(folder, name):
    return FigureFiles(*(folder / f"{name}.{form}" for form in ("png", "pdf", "csv")), DPI)


@pytest.fixture(scope="module")
def repeated(bed, tmp_path_factory):
    """mixing.csv and metrics.csv with two repeats: the same rolls, another random walk."""
    folder = tmp_path_factory.mktemp("repeated")
    curves = []
    for number in (1, 2):
        part = folder / str(number)
        part.mkdir()
        times = np.round(np.arange(COMPARE[0], COMPARE[1] + 1e-9, LAG), 6)
        frames = rolling_bed(NUMBER, WIDTH, 0.12, times, seed=10 + number)
        dem = write_run(part, frames, times, WIDTH, HEIGHT)
        parse_dumps(dem, part / "t.npy", part / "t.json", WIDTH, HEIGHT, progress=False)
        curves.append(part / "mixing.csv")
        measure_mixing(
            BedFiles(part / "t.npy", part / "t.json"), curves[-1], f"dem_{number}", COMPARE, SPLITS
        )
    mixing, metrics = folder / "mixing.csv", folder / "metrics.csv"
    compare_mixing(
        bed.files, bed.chain_files, SolverSeries(bed.series, LEARN, WEIGHT_PA), curves,
        Tables(mixing, metrics), COMPARE, SPLITS, BATCH,
    )  # fmt: skip
    return mixing, metrics


def test_repeats_are_in_the_table_and_give_the_noise_floor(repeated):
    mixing, metrics = (pd.read_csv(file) for file in repeated)
    assert list(dict.fromkeys(mixing["source"]))[:3] == ["dem", "dem_1", "dem_2"]
    wide = mixing.pivot(index=["group", "time_s"], columns="source", values="fraction_remaining_1")
    after = wide[wide.index.get_level_values("time_s") > mixing["time_s"].min()]
    variance = after[["dem", "dem_1", "dem_2"]].var(axis=1, ddof=1).groupby("group").mean()
    rows = metrics.set_index(["source", "quantity"])["value"]
    for group in GROUPS:
        assert rows["dem", f"noise_floor_{group}"] == pytest.approx(variance[group] ** 0.5, rel=1e-6)
        for model in MODELS:
            over = rows[model, f"error_rms_{group}"] / rows["dem", f"noise_floor_{group}"]
            assert rows[model, f"error_over_noise_{group}"] == pytest.approx(over, rel=1e-6)
    assert rows["dem", "realisations"] == 3


def test_fig5_has_the_band_of_all_realisations(repeated, bed, tmp_path):
    plot_mixing(*repeated, bed.chain_files, forms(tmp_path, "fig5a"), "radial", COLOURS)
    table = pd.read_csv(tmp_path / "fig5a.csv")
    dem = table[table["source"] == "dem"].set_index(["group", "time_s"])
    runs = table[table["source"].isin(["dem", "dem_1", "dem_2"])].groupby(["group", "time_s"])
    shares = runs["fraction_remaining_1"]
    pd.testing.assert_series_equal(dem["band_low_1"], shares.min()[dem.index], check_names=False)
    pd.testing.assert_series_equal(dem["band_high_1"], shares.max()[dem.index], check_names=False)
    assert (dem["band_high_1"] > dem["band_low_1"]).any()


@pytest.fixture(scope="module")
def discussion(bed, tmp_path_factory):
    """Table of the small bed; a lag of 0.3 s does not divide the comparison."""
    file = tmp_path_factory.mktemp("discussion") / "discussion.csv"
    discuss_errors(
        bed.files, bed.mixing, file, LEARN, COMPARE, SPLITS,
        CaseChains(COLUMNS, ROWS, LAG, "pooled"), Scanned(list(MODELS), SIZES, LAGS),
    )  # fmt: skip
    return file


def test_errors_of_the_own_grid_are_those_of_the_metrics(discussion, bed):
    table = pd.read_csv(discussion)
    rows = pd.read_csv(bed.metrics).set_index(["source", "quantity"])["value"]
    own = table[np.isclose(table["cell_m"], WIDTH / COLUMNS) & np.isclose(table["lag_s"], LAG)]
    for model in MODELS:
        for group in GROUPS:
            for quantity in ("error_signed", "error_rms"):
                part = own.query("source == @model and part == @group and quantity == @quantity")
                assert part["value"].item() == pytest.approx(rows[model, f"{quantity}_{group}"], abs=1e-6)


def test_every_combination_that_is_asked_for_is_run(discussion):
    table = pd.read_csv(discussion)
    assert sorted(table["lag_s"].dropna().unique()) == pytest.approx([0.025, 0.1])
    runs = table.query("quantity == 'error_rms' and part == 'left'").groupby("source").size()
    assert runs.to_dict() == {"static": 3 * 2, "dynamic": 3 + 2 - 1}
    assert (table.query("quantity == 'dispersion'")["value"] > 0).all()


def test_larger_cells_add_what_theory_says(discussion):
    table = pd.read_csv(discussion).query("source == 'dem' and lag_s < 0.03")
    wide = table.pivot(index=["part", "cell_m"], columns="quantity", values="value")
    counted = wide["dispersion_of_cells"] - wide["dispersion"]
    fine = wide.index.get_level_values("cell_m") < 0.03
    share = (counted / wide["dispersion_added"])[fine]
    # walls and the rolls' own pattern make places in a cell uneven: less is added, least in large cells
    assert share.between(0.6, 1.05).all() and share.max() > 0.9


def test_discussion_is_drawn_for_its_own_cells_only(discussion, tmp_path):
    plot_discussion(discussion, forms(tmp_path, "fig"), 0.01, LAG, COLOURS)
    files = forms(tmp_path, "fig")
    assert all(file.stat().st_size > 1000 for file in (files.png, files.pdf, files.csv))
    with pytest.raises(UserError, match="other cells or another lag"):
        plot_discussion(discussion, forms(tmp_path, "fig"), 0.07, LAG, COLOURS)


def test_rolls_are_steady(bed, tmp_path):
    plot_stationarity(
        bed.series, bed.files, tmp_path / "s.csv", forms(tmp_path, "fig"),
        Window(LEARN.start_s, COMPARE.end_s), SPLITS, 0.01, Slab(DIAMETER, DIAMETER),
    )  # fmt: skip
    table = pd.read_csv(tmp_path / "s.csv").set_index("quantity")
    assert table.loc["pressure_drop", "mean"] == pytest.approx(WEIGHT_PA, rel=0.02)
    assert table.loc["pressure_drop", "stationary_1"] == 1
    assert (table.loc["voidage", "height_m"] < 0.13).all()
    files = forms(tmp_path, "fig")
    assert all(file.stat().st_size > 1000 for file in (files.png, files.pdf, files.csv))


def test_bubbles_of_rolls_and_of_the_model(bed, tmp_path):
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    window = Window(LEARN.start_s, COMPARE.end_s)
    plot_bubbles(bed.files, forms(tmp_path, "fig"), window, case, tmp_path / "bubbles.csv")
    files = forms(tmp_path, "fig")
    assert all(file.stat().st_size > 1000 for file in (files.png, files.pdf, files.csv))
    table = pd.read_csv(files.csv)
    voidage = table[(table["quantity"] == "voidage") & (table["source"] == "dem")]
    assert voidage["value"].between(0, 1).all()
    assert set(table["source"]) == {"dem", "two_phase"}
    case["gas"]["superficial_velocity_m_s"] = 0.4
    plot_bubbles(bed.files, forms(tmp_path, "fixed"), window, case, tmp_path / "bubbles.csv")
    assert set(pd.read_csv(forms(tmp_path, "fixed").csv)["source"]) == {"dem"}


def test_film_shows_every_step_and_moves(bed, tmp_path):
    film, shown = tmp_path / "film.mp4", Window(2.0, 2.25)
    make_film(
        bed.files, list(bed.transitions.values()), film, shown,
        Halves(SPLITS.split_x_m, ["#4477aa", "#ee7733"]), Slab(DIAMETER, DIAMETER), 0.01, seed=1,
    )  # fmt: skip
    frames = imageio_ffmpeg.read_frames(str(film))
    wide, high = next(frames)["size"]
    pictures = [np.frombuffer(frame, np.uint8).reshape(high, wide, 3).astype(int) for frame in frames]
    assert len(pictures) == round((shown.end_s - shown.start_s) / LAG) + 1
    panels = 2 + len(bed.transitions)
    changed = (np.abs(pictures[0] - pictures[-1]) > 60).any(axis=2)
    blue = pictures[0][..., 2] - pictures[0][..., 0] > 60
    # DEM, voidage and all chains move; one half of the particles is blue to begin with
    for part in np.array_split(np.arange(wide), panels):
        assert changed[:, part].mean() > 0.01 and blue[:, part].sum() > 100
