# SPDX-License-Identifier: GPL-3.0-or-later
"""Changed settings of a bed: steps and cells still divide what they must, and the case itself stays."""

import copy

import pytest

from bedchain.case.bed_settings import (
    coupling_s,
    dem_step,
    gas_cell,
    gas_step,
    parcels,
    problems_with,
    stiffness,
)
from bedchain.case.load import load_case
from bedchain.case.schema import with_values
from bedchain.physics.whole_numbers import is_multiple
from made import ROOT


@pytest.fixture(scope="module", params=["short", "paper", "mueller"])
def case(request):
    return load_case(ROOT / "cases" / request.param / "case.yaml")


@pytest.mark.parametrize("factor", [0.5, 2.0, 4.0])
def test_gas_cells_are_square_and_divide_the_bed(case, factor):
    cell_m = gas_cell(case, factor)["gas.cell_size_m"]
    assert all(is_multiple(case["bed"][name], cell_m) for name in ("width_m", "height_m"))
    assert cell_m / case["gas"]["cell_size_m"] == pytest.approx(factor, rel=0.5)


@pytest.mark.parametrize("factor", [0.2, 0.5, 2.0])
def test_steps_divide_each_other_and_the_frames(case, factor):
    time = with_values(case, gas_step(case, factor))["time"]
    assert is_multiple(time["frame_interval_s"], time["gas_step_s"])
    assert is_multiple(time["gas_step_s"], time["dem_step_s"])
    assert time["gas_step_s"] <= factor * case["time"]["gas_step_s"] * (1 + 1e-9)


def test_stiffer_particles_keep_their_share_of_the_rayleigh_time(case):
    stiffer = with_values(case, stiffness(case, 4.0))
    assert stiffer["contact"]["young_modulus_Pa"] == 4 * case["contact"]["young_modulus_Pa"]
    # at most half the step, and no more steps than divide the gas step
    assert 0.4 < stiffer["time"]["dem_step_s"] / case["time"]["dem_step_s"] <= 0.5 * (1 + 1e-9)
    assert is_multiple(coupling_s(case), stiffer["time"]["dem_step_s"])


@pytest.mark.parametrize("factor", [0.4, 1.6])
def test_the_step_alone_changes_and_divides_the_gas_step(case, factor):
    changed = with_values(case, dem_step(case, factor))
    step_s = changed["time"]["dem_step_s"]
    assert 0.6 * factor < step_s / case["time"]["dem_step_s"] <= factor * (1 + 1e-9)
    assert is_multiple(coupling_s(case), step_s) and changed["contact"] == case["contact"]


def test_what_cannot_be_simulated_is_named_and_the_case_stays_as_it_is(case):
    before = copy.deepcopy(case)
    assert with_values(case, parcels(2.0))["particles"]["parcel_diameters"] == 2.0 and case == before
    assert not problems_with(case, {})
    assert any("parcel" in problem.wrong for problem in problems_with(case, parcels(50.0)))
