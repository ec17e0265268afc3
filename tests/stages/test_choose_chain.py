# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag and the cells by rule, from files to table and figure, of walkers whose memory is known."""

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import DataError
from bedchain.figures.style import FigureFiles
from bedchain.measures.mixing import Splits
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from choose_chain import choose_chain
from made.frames import INTERVAL_S
from made.persistent_walk import write, write_bed
from plot_choice import plot_choice

BOX_M, SPLITS, DIAMETER_M = 0.3, Splits(0.15, 0.15), 1e-3
WINDOW = Window(1.0, 4.0)


def choose(trajectory, folder):
    files = BedFiles(trajectory, trajectory.with_suffix(".json"))
    choose_chain(files, folder / "choice.csv", folder / "curve.csv", WINDOW, SPLITS, DIAMETER_M)
    return pd.read_csv(folder / "choice.csv"), pd.read_csv(folder / "curve.csv")


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walk")
    trajectory = write_bed(folder, 161, 300, BOX_M, 0.1, 0.2, 3)
    return folder, *choose(trajectory, folder)


def test_the_table_gives_lag_and_cells_and_what_they_rest_on(walk):
    _, choice, _ = walk
    assert list(choice.columns) == ["quantity", "value", "unit", "why"]
    value = choice.set_index("quantity")["value"]
    assert value["lag_s"] / INTERVAL_S == pytest.approx(round(value["lag_s"] / INTERVAL_S))
    assert 0.2 <= value["lag_low_s"] <= value["lag_high_s"] <= 0.6
    assert 0.25 <= value["lag_s"] <= 1.0  # a third of the window
    assert value["cell_m"] == pytest.approx(BOX_M / value["columns"]) and value["columns"] == value["rows"]
    assert max(value["added_x_1"], value["added_z_1"]) < 0.05
    assert value["correlation_x_s"] == pytest.approx(0.1, rel=0.3)
    assert choice["why"].notna().all()


def test_the_curve_has_its_band(walk):
    _, _, curve = walk
    dispersion = curve[curve["quantity"] == "dispersion"]
    assert set(dispersion["axis"]) == {"x", "z"}
    assert (dispersion["ci_low"] <= dispersion["value"]).all()
    assert (dispersion["value"] <= dispersion["ci_high"]).all()


def test_the_figure_shows_the_numbers_of_the_curve(walk):
    folder, _, curve = walk
    files = FigureFiles(*(folder / f"f.{form}" for form in ("png", "pdf", "csv")), 50)
    plot_choice(folder / "choice.csv", folder / "curve.csv", files)
    pd.testing.assert_frame_equal(pd.read_csv(files.csv), curve)
    assert files.png.exists() and files.pdf.exists()


def test_particles_at_rest_end_in_a_clear_word_and_no_file(tmp_path):
    places = np.random.default_rng(1).uniform(0.1, 0.2, (1, 4, 50)) * np.ones((161, 1, 1))
    trajectory = write(tmp_path, places, BOX_M)
    with pytest.raises(DataError, match="at rest.*give chain.lag_s and cells"):
        choose(trajectory, tmp_path)
    assert not list(tmp_path.glob("*.csv"))
