# SPDX-License-Identifier: GPL-3.0-or-later
"""What is written down about a bed: the two-phase model and plug flow."""

import time

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.physics.two_phase import RegimeError
from bedchain.studies.ladder.answers import of_density
from bedchain.studies.ladder.models import of_two_phase, of_wakes, plug_flow, timed
from bedchain.trajectory.grid import Grid
from made import ROOT


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def test_the_two_phase_model_says_height_pressure_voidage_and_bubbles_and_no_mixing(case):
    grid = Grid(0.1, 0.4, 10, 40)
    answer = of_two_phase(case, grid, 2.0)
    assert answer.values["particle_height"] == pytest.approx(0.0603, rel=3e-3)
    assert answer.values["pressure_drop"] == pytest.approx(1202, abs=1)
    assert set(answer.values) == {
        "particle_height", "pressure_drop", "voidage", "bubble_diameter", "bubble_velocity",
    }  # fmt: skip
    solids = (1 - answer.values["voidage"]).sum() * 0.01 * 0.1 * 1e-3
    assert solids == pytest.approx(9000 * np.pi / 6 * 1e-9, rel=1e-4)
    rows = np.repeat((1 - answer.values["voidage"]) / (1 - answer.values["voidage"]).sum() / 10, 10)
    assert of_density(rows, grid, case)["particle_height"] == pytest.approx(0.0603, rel=0.01)


def test_outside_its_regime_it_has_no_answer(case):
    case["gas"]["superficial_velocity_m_s"] = 0.3
    with pytest.raises(RegimeError, match="fixed bed"):
        of_two_phase(case, Grid(0.1, 0.4, 10, 40), 2.0)


def test_in_plug_flow_nothing_crosses_a_line():
    answer = plug_flow(2.0, 0.5)
    np.testing.assert_array_equal(answer.values["mixing_axial"], np.ones((5, 2)))


def test_short_work_is_timed_by_many_runs():
    calls = []
    result, spent = timed(lambda: calls.append(1) or sum(range(10000)))
    assert result == sum(range(10000)) and len(calls) > 10 and 0 < spent < 0.1


def test_wakes_say_axial_mixing_alone(case):
    answer = of_wakes(case, Grid(0.1, 0.4, 10, 40), 2.0, 0.1)
    assert set(answer.values) == {"mixing_axial"}
    curves = answer.values["mixing_axial"]
    assert curves.shape == (21, 2) and curves[0] == pytest.approx([1, 1])
    assert (curves[-1] < 0.9).all() and (curves > 0).all()


def test_what_is_loaded_once_is_not_timed():
    calls = []

    def work():
        calls.append(1)
        until = time.process_time() + (0.4 if len(calls) == 1 else 0.001)
        while time.process_time() < until:
            pass

    assert timed(work)[1] < 0.01
