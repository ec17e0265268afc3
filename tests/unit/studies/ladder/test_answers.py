# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of answers by hand, and rows only for what a model says."""

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.errors import DataError
from bedchain.studies.ladder.answers import (
    Answer,
    Truth,
    distance,
    error_of,
    ladder_rows,
    of_density,
    read_answer,
    write_answer,
)
from bedchain.trajectory.grid import Grid
from made import ROOT


def test_distances_by_hand():
    assert distance("particle_height", 0.22, 0.2) == pytest.approx(0.1)
    assert distance("density", np.array([0.5, 0.5]), np.array([0.7, 0.3])) == pytest.approx(0.2)
    assert distance("voidage", np.array([0.5, 0.9]), np.array([0.5, 0.7])) == pytest.approx(np.sqrt(0.02))
    curves = np.array([[1.0], [0.9], [0.8]])
    assert distance("mixing_axial", curves, curves + [[5], [0.1], [0.1]]) == pytest.approx(0.1)


def test_curves_are_compared_where_both_have_a_time():
    seen = np.linspace(1, 0, 11)[:, None]
    truth = Truth({"mixing_axial": seen}, {"mixing_axial": 0.05}, 0.1)
    answer = Answer("chain", {"mixing_axial": seen[::2] - [[0.0]] + 0.1}, 1.0, lag_s=0.2)
    assert error_of("mixing_axial", answer, truth) == pytest.approx(0.1)
    longer = Answer("chain", {"mixing_axial": np.r_[seen, seen]}, 1.0, lag_s=0.1)
    assert error_of("mixing_axial", longer, truth) == 0


def test_a_model_has_rows_for_what_it_says():
    truth = Truth({"particle_height": 0.2, "pressure_drop": 4000.0}, {"particle_height": 0.01}, 0.1)
    rows = ladder_rows([Answer("a", {"particle_height": 0.202}, 2.0, paths=True)], truth)
    assert list(rows.columns[:2]) == ["model", "quantity"]
    assert rows["quantity"].tolist() == ["particle_height", "single_paths"]
    assert rows.loc[0, "error_floors"] == pytest.approx(1) and rows.loc[0, "unit"] == "m"


def test_height_and_voidage_of_an_even_density():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    grid = Grid(0.1, 0.4, 2, 4)
    values = of_density(np.array([0.25, 0.25, 0.25, 0.25, 0, 0, 0, 0]), grid, case)
    assert values["particle_height"] == pytest.approx(0.1)
    solids = 9000 * np.pi / 6 * 1e-9 / (0.1 * 1e-3 * 0.2)
    np.testing.assert_allclose(values["voidage"], [1 - solids, 1 - solids, 1, 1])


def test_a_model_that_ran_elsewhere_is_read_as_written(tmp_path):
    curves = np.array([[1.0, 1.0], [0.9, 0.8]])
    answer = Answer(
        "parcels", {"particle_height": 0.2, "mixing_axial": curves}, 12.5, lag_s=0.1, note="8 in 1"
    )
    write_answer(answer, tmp_path / "parcels.json")
    again = read_answer(tmp_path / "parcels.json")
    np.testing.assert_array_equal(again.values["mixing_axial"], curves)
    assert (again.model, again.cost_s, again.lag_s, again.note) == ("parcels", 12.5, 0.1, "8 in 1")
    assert np.isnan(again.learning_s) and again.values["particle_height"] == 0.2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"model": "parcels", "values": {}}', "lacks cost_s"),
        ('{"model": "p", "cost_s": 1, "values": {"height": 1}}', "height is known to no ladder"),
        ('{"model": "p", "cost_s": 1, "values": {"voidage": [1, [2]]}}', "no number or no even list"),
        ('{"model": "p", "cost_s": 1, "colour": 2, "values": {}}', "colour is known to no ladder"),
        ("[1", "is no JSON"),
    ],
)
def test_a_damaged_model_is_refused(tmp_path, text, message):
    file = tmp_path / "parcels.json"
    file.write_text(text)
    with pytest.raises(DataError, match=message):
        read_answer(file)
