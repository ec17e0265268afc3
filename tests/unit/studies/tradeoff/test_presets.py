# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the chains in the trade-off study, and presets chosen among them."""

import numpy as np
import pandas as pd
import pytest
import yaml

from bedchain.case.presets import count_near
from bedchain.errors import UserError
from bedchain.studies.pareto import pareto_front
from bedchain.studies.tradeoff.chain_settings import FACTORIAL, ORDER, chain_settings
from bedchain.studies.tradeoff.presets import choose, knee, nominal_cell, write_presets
from made.realisations import own


def test_cells_divide_levels_and_keep_the_lines():
    # the paper's bed: 540 levels of half a diameter, its middle column cut by the line; its other line is not
    assert count_near(0.27, 0.01, 0.135, 27, 1e-3) == 27
    assert count_near(0.27, 0.02, 0.135, 27, 1e-3) in {12, 15}
    # 2100 levels; 0.25 m of 1.05 m stays a border: multiples of 21
    assert {count_near(1.05, cell, 0.25, 105, 1e-3) % 21 for cell in (0.0025, 0.01, 0.03, 0.05)} == {0}
    # the line was a border, so it stays one: even counts only
    assert count_near(0.1, 0.033, 0.05, 10, 1e-3) == 4


def test_nominal_cells_give_the_columns_and_rows_that_they_stand_for():
    for case in (own(), own(27, 105, 0.27, 1.05, splits=(0.135, 0.25))):
        tried = [one for one in chain_settings(case) if one.axis in (FACTORIAL, ORDER)]
        assert len(tried) > 20
        for one in tried:
            assert case.near(nominal_cell(one.columns, one.rows, case)) == (one.columns, one.rows)


def front_table():
    """Chains with a front of five, a dominated one, a shape that may not be chosen, one not validated."""
    table = pd.DataFrame(
        {
            "axis": [FACTORIAL, FACTORIAL, ORDER, FACTORIAL, FACTORIAL, FACTORIAL, "cell shape", FACTORIAL],
            "cost_s": [1e-3, 4e-3, 1.0, 1e-2, 0.1, 0.2, 1e-3, 1e-3],
            "validation_error_1": [0.30, 0.09, 0.050, 0.06, 0.055, 0.07, 0.01, np.nan],
        }
    )
    table["model"] = ["dynamic" if axis == ORDER else "static" for axis in table["axis"]]
    table["cell_width_m"], table["cell_height_m"], table["lag_s"] = 0.01, 0.01, 0.025
    table["density_floors_1"] = 1.5
    table["mixing_floors_1"] = np.linspace(3, 1, len(table))
    return table


def test_presets_are_chosen_by_validation_and_cost():
    table = front_table()
    front = pareto_front(table.iloc[:6], "cost_s", "validation_error_1")
    assert front.index.tolist() == [0, 1, 3, 4, 2]
    # two floors allow 0.09; the knee between it and the best is the one where the curve turns
    assert choose(table, 0.045) == {"fast": 1, "balanced": 3, "accurate": 2}
    # without a floor, half as much again as the lowest; what is between lies above the chord
    assert choose(table, np.nan) == {"fast": 3, "balanced": 2, "accurate": 2}
    assert choose(table.iloc[:1], 0.001) == {"fast": 0, "balanced": 0, "accurate": 0}
    with pytest.raises(UserError, match="no chain could be validated"):
        choose(table.iloc[6:], 0.045)


def test_errors_of_the_comparison_window_choose_nothing():
    table = front_table()
    assert choose(table.assign(mixing_floors_1=table["mixing_floors_1"].to_numpy()[::-1]), 0.045) == choose(
        table, 0.045
    )


def test_the_knee_is_below_the_chord():
    straight = pd.DataFrame({"cost_s": [1, 10, 100], "validation_error_1": [1.0, 0.5, 0.25]})
    assert knee(straight) == 2
    assert knee(straight.assign(validation_error_1=[1.0, 0.3, 0.25])) == 1
    assert knee(straight.assign(validation_error_1=[1.0, 0.9, 0.25])) == 2


def test_presets_are_written_as_a_case_reads_them(tmp_path):
    table, path = front_table(), tmp_path / "presets.yaml"
    table.loc[2, "mixing_floors_1"] = np.nan
    write_presets(table, choose(table, 0.045), own(), "a bed; a machine", path)
    found = yaml.safe_load(path.read_text())
    assert list(found) == ["fast", "balanced", "accurate"]
    assert found["fast"] == {
        "cell_m": 0.01, "lag_s": 0.025, "model": "static", "cost_s": 0.004, "error_floors": 2.71,
        "density_floors": 1.5, "measured_on": "a bed; a machine",
    }  # fmt: skip
    assert found["accurate"]["model"] == "dynamic" and found["accurate"]["error_floors"] is None
