# SPDX-License-Identifier: GPL-3.0-or-later
"""Every figure is there in both forms with its numbers, and is not a blank page."""

import math

import matplotlib.image
import numpy as np
import pandas as pd
import pytest

from bedchain.case.parameters import solver_parameters
from bedchain.case.schema import load_schema

NAMES = ["fig1_cells", "fig2_cost", "fig3_static", "fig4_dynamic", "fig5a_radial", "fig5b_axial", "snapshot"]
NAMES += ["fig_difference", "fig_chapman_kolmogorov", "fig_timescales", "fig_stationarity", "fig_discussion"]
NAMES += ["fig_choice", "fig_modes"]
# a page that failed to draw has a frame at most
LEAST_INK = 0.01


@pytest.fixture(scope="module")
def folder(results):
    """Where the figures are."""
    return results / "figures"


@pytest.mark.parametrize("name", NAMES)
def test_figure_is_drawn(folder, name):
    picture = matplotlib.image.imread(folder / f"{name}.png")[..., :3]
    assert (picture.min(axis=2) < 0.9).mean() > LEAST_INK
    pdf = (folder / f"{name}.pdf").read_bytes()
    assert pdf.startswith(b"%PDF") and b"%%EOF" in pdf[-64:]


@pytest.mark.parametrize("name", NAMES)
def test_figure_has_its_numbers_beside_it(folder, name):
    numbers = pd.read_csv(folder / f"{name}.csv").select_dtypes("number")
    assert len(numbers) > 0
    # a column of nothing, or of one number only, is a curve that was not drawn
    assert numbers.nunique().max() > 2 and np.isfinite(numbers.to_numpy()).any(axis=0).all()


def test_snapshot_shows_every_particle(folder, case):
    parts = pd.read_csv(folder / "snapshot.csv").groupby("part").size()
    assert parts["particle"] == case["particles"]["number"]
    numbers = {given.name: given.value for given in solver_parameters(case, load_schema())}
    assert parts["gas_cell"] == math.prod(numbers[f"gas_cells_{along}"] for along in "xyz")


def test_snapshot_has_bubbles_and_bed(folder):
    voidage = pd.read_csv(folder / "snapshot.csv")["voidage_1"].dropna()
    assert voidage.min() < 0.55
    assert voidage.max() == pytest.approx(1, abs=0.01)


def test_table_has_the_values_of_the_case_in_three_forms(results, case):
    table = pd.read_csv(results / "table1.csv").set_index("key")
    assert float(table.loc["particles.number", "this_case"]) == case["particles"]["number"]
    for form in ("html", "tex"):
        text = (results / f"table1.{form}").read_text(encoding="utf-8")
        assert str(case["particles"]["number"]) in text and "drag law" in text
