# SPDX-License-Identifier: GPL-3.0-or-later
"""Beds of the study: alike at any size, with steps that nest, refused beyond a limit."""

from dataclasses import replace

import pytest
import yaml

from bedchain.case.load import load_case
from bedchain.errors import CaseError
from bedchain.studies.stability import theory
from bedchain.studies.stability.beds import StabilityBed, case_of, changes, clock, scene, times, two_digits

ROUND_OFF = 1e-9


def test_beds_of_any_size_are_alike():
    for diameter, density in ((5e-5, 2600.0), (5e-3, 2600.0), (1e-3, 12000.0)):
        one = StabilityBed(diameter=diameter, density=density)
        assert theory.overlap_at_rest(scene(one), one.number) == pytest.approx(
            theory.overlap_at_rest(scene(StabilityBed()), StabilityBed().number)
        )
        ratio = clock(one)["dem_step_s"] / theory.rayleigh(scene(one))
        assert 0.15 < ratio <= 0.18


@pytest.mark.parametrize("gas_step", [1e-5, 1e-4, 1e-2])
@pytest.mark.parametrize("diameter", [5e-5, 5e-3])
def test_times_of_a_bed_nest_and_it_can_be_run(gas_step, diameter, tmp_path):
    bed = StabilityBed(diameter=diameter, gas_step=gas_step)
    if gas_step > theory.free_fall_limit(scene(bed), gas_step).value:
        with pytest.raises(CaseError, match="time.gas_step_s"):
            loaded(bed, tmp_path)
        return
    time_of = loaded(bed, tmp_path)["time"]
    assert time_of["gas_step_s"] == pytest.approx(gas_step, rel=0.5)
    assert time_of["end_s"] >= 80 * time_of["gas_step_s"] * (1 - ROUND_OFF)


def loaded(bed, folder):
    """The checked case of a bed."""
    file = folder / "case.yaml"
    file.write_text(yaml.safe_dump(case_of(bed)))
    return load_case(file)


def test_numbers_have_few_digits_and_their_multiples_are_exact():
    assert two_digits(4.4219e-8) == 4.4e-8
    assert two_digits(2.0e-5) == 2.0e-5
    assert times(5e-5, 20) == 1e-3
    assert changes(StabilityBed(velocity=0.3, cell=4)) == {
        "gas.superficial_velocity_m_s": 0.3, "gas.cell_size_m": 4e-3, "discussion.cell_sizes_m": [4e-3],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("bed", "key", "better"),
    [
        (StabilityBed(young=5e3, dem_step=5e-5), "contact.young_modulus_Pa", {"young": 2.5e4}),
        (StabilityBed(density=11.9, velocity=0.1), "gas.density_kg_m3", {"density": 12.1}),
        (StabilityBed(gas_step=1.2e-2), "time.gas_step_s", {"gas_step": 3e-3}),
        (StabilityBed(cell=10), "gas.cell_size_m", {"cell": 5}),
        (StabilityBed(dem_step=4.4e-5), "time.dem_step_s", {"dem_step": 4e-5}),
    ],
    ids=["soft", "light", "slow_gas", "coarse_gas", "long_step"],
)
def test_settings_beyond_a_limit_are_refused_and_those_within_are_not(bed, key, better, tmp_path):
    with pytest.raises(CaseError) as error:
        loaded(bed, tmp_path)
    assert [problem.key for problem in error.value.problems] == [key]
    assert "take at most" in str(error.value) or "take at least" in str(error.value)
    loaded(replace(bed, **better), tmp_path)  # raises where it is refused


def test_a_layer_whose_lattice_is_higher_than_the_box_is_refused(tmp_path):
    # 17 columns and 51 rows of 1.15 diameters; more would silently not be there
    assert loaded(StabilityBed(number=17 * 51), tmp_path)["particles"]["number"] == 867
    with pytest.raises(CaseError, match="particles.number.*take at most"):
        loaded(StabilityBed(number=17 * 51 + 1), tmp_path)


def test_one_particle_or_few_may_have_any_gas_cell(tmp_path):
    assert loaded(StabilityBed(number=1, cell=20), tmp_path)["gas"]["cell_size_m"] == 0.02
