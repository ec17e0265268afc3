# SPDX-License-Identifier: GPL-3.0-or-later
"""How settings are judged, the limits by theory, and a study that goes on whatever its settings do."""

import itertools
import math
import os
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from bedchain.case.bed_checks import OVERLAP_AT_REST_MAX
from bedchain.case.gas_checks import FREE_FALL_SHARE_MAX, GAS_CELL_MAX
from bedchain.case.load import load_case
from bedchain.dem import processes
from bedchain.errors import CaseError, Problem, UserError
from bedchain.physics.contacts import contact_modulus, static_overlap
from bedchain.studies.stability import theory
from bedchain.studies.stability.bed_runs import Expected, checks, momentum, observe
from bedchain.studies.stability.bed_settings import bed_settings
from bedchain.studies.stability.beds import StabilityBed, case_of, changes, clock, scene, times, two_digits
from bedchain.studies.stability.chain_settings import chain_settings
from bedchain.studies.stability.collisions import Collision, pairs
from bedchain.studies.stability.maps import draw_maps
from bedchain.studies.stability.settings import StabilitySetting, chosen
from bedchain.studies.stability.study import limited, row_of, run_study
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import (
    CRASHED,
    DIVERGED,
    HUNG,
    INACCURATE,
    REFUSED,
    STABLE,
    Verdict,
    judge,
    stopped,
)
from bedchain.studies.stability.verdict import refused as refused_verdict
from bedchain.studies.verification.rows import Row

ROUND_OFF = 1e-9
END = "The last finished segment is intact: reduce"
SAID = {
    "overlap": "particle 12 at (0.001 0 0.002) m and the wall bottom overlap by 0.7 diameters, above "
    f"contact.largest_overlap_1 (0.5), at 0.01 s. {END}",
    "lost particle": f"particle 9 has left the bed (3 lost), last seen at (0.01 0 0.06) m, at 0.02 s. {END}",
    "voidage": f"voidage 0.1 in the gas cell at (0.0025 0 0.0075) m, below it (2 cells), at 0 s. {END}",
    "pressure": "the pressure is not solved after 1000 iterations (residual 1 before, 2 after), largest "
    f"residual 3 in the gas cell at (0.0025 0 0.0075) m, at 0.5 s. {END}",
    "divergence": "the run has diverged (pressure drop nan Pa, kinetic energy inf J), fastest gas [m/s] nan "
    f"in the gas cell at (0.0025 0 0.0075) m, at 1e-05 s. {END}",
}


@pytest.mark.parametrize("guard", SAID)
def test_the_solvers_own_words_tell_guard_place_and_time(guard):
    found = stopped(f"run_dem: settling\nerror: bedFoam ended with code 1:\n  --> FATAL :\n{SAID[guard]} it")
    assert (found.outcome, found.guard) == (DIVERGED, guard)
    assert found.x_m > 0 and found.z_m > 0 and found.time_s >= 0
    assert "intact" not in found.reason and found.reason.endswith("s.")


def test_particles_lost_while_they_settle_are_a_stop_too():
    found = stopped("ERROR: Lost atoms: original 64 current 61 (thermo.cpp:480)")
    assert (found.outcome, found.guard) == (DIVERGED, "lost particle while settling")
    assert math.isnan(found.time_s)


def test_an_end_that_no_guard_explains_is_a_fault_of_ours():
    assert stopped("bedFoam ended with code -11: its whole log: x").outcome == CRASHED
    assert stopped(f"Traceback (most recent call last): {SAID['overlap']}").outcome == CRASHED


def test_the_worst_quantity_decides_and_a_nan_is_never_stable():
    good, bad = Row("a [1]", 1.01, 1, 0.05, "x"), Row("b [1]", 0.3, 0, 0.1, "x")
    assert judge([good]).outcome == STABLE
    found = judge([good, bad])
    assert (found.outcome, found.quantity, found.value) == (INACCURATE, "b [1]", 0.3)
    assert judge([good, Row("c [1]", math.nan, 0, 0.1, "x"), bad]).quantity == "c [1]"
    assert judge([Row("d [1]", 1.0, math.nan, 0.1, "x")]).outcome == INACCURATE


def test_a_refused_case_tells_its_keys():
    problems = [Problem("gas.cell_size_m", "0.1 m is too large", "take 0.01"), Problem("a.b", "no", "yes")]
    found = refused_verdict(CaseError("case.yaml", problems))
    assert (found.outcome, found.guard) == (REFUSED, "check of gas.cell_size_m")
    assert "0.1 m is too large" in found.reason and "a.b" in found.reason


def test_the_overlap_at_rest_carries_the_load_by_hertz():
    young, poisson, density, diameter, number, width = 2e6, 0.3, 2600.0, 1e-3, 300, 0.02
    overlap = static_overlap(young, poisson, density, diameter, number, width, diameter) * diameter
    force = 4 / 3 * contact_modulus(young, poisson) * math.sqrt(diameter / 4) * overlap**1.5
    layers = number * diameter / width
    assert force == pytest.approx(layers * density * math.pi / 6 * diameter**3 * 9.81)
    # Ten times as deep between its walls, with ten times as many particles
    deep = static_overlap(young, poisson, density, diameter, 10 * number, width, 10 * diameter) * diameter
    assert deep == pytest.approx(overlap)


def stiffest_wave(size=12):
    """Largest m omega^2 / k of a triangular lattice of masses and springs, by its dynamical matrix."""
    bonds = [(1.0, 0.0), (0.5, math.sqrt(3) / 2), (-0.5, math.sqrt(3) / 2)]
    largest = 0.0
    for i, j in itertools.product(range(size), repeat=2):
        # Wave vectors from the reciprocal lattice
        wave = 2 * math.pi / size * np.array([i, (2 * j - i) / math.sqrt(3)])
        matrix = sum(2 * (1 - math.cos(wave @ np.array(b))) * np.outer(b, b) for b in bonds)
        largest = max(largest, float(np.linalg.eigvalsh(matrix)[-1]))
    return largest


def test_the_stiffest_wave_of_closest_discs_is_that_of_the_lattice():
    assert stiffest_wave() == pytest.approx(theory.LATTICE_STIFFNESS)


def test_central_differences_diverge_just_above_the_oscillators_limit():
    bed = StabilityBed(young=1e6)
    small = scene(bed)
    limit = theory.oscillator_step(small, bed.number)
    omega = 2 / limit
    for share, grows in ((0.99, False), (1.01, True)):
        step, place, speed = share * limit, 1.0, 0.0
        for _ in range(2000):
            speed -= step * omega**2 * place
            place += step * speed
        assert (abs(place) > 1e3) == grows


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
        (StabilityBed(dem_step=2.2e-5), "time.dem_step_s", {"dem_step": 2e-5}),
    ],
    ids=["soft", "light", "slow_gas", "coarse_gas", "long_step"],
)
def test_settings_beyond_a_limit_are_refused_and_those_within_are_not(bed, key, better, tmp_path):
    with pytest.raises(CaseError) as error:
        loaded(bed, tmp_path)
    assert [problem.key for problem in error.value.problems] == [key]
    assert "take at most" in str(error.value) or "take at least" in str(error.value)
    assert loaded(replace(bed, **better), tmp_path)


def test_the_deepest_overlap_is_that_of_a_fall_of_one_diameter_where_particles_are_stiff():
    stiff = scene(StabilityBed(young=1e9))
    overlap = theory.deepest_overlap(stiff, 64) * stiff.diameter
    modulus = contact_modulus(stiff.young, stiff.poisson)
    stored = 8 / 15 * modulus * math.sqrt(stiff.diameter / 4) * overlap**2.5
    mass = stiff.density * math.pi / 6 * stiff.diameter**3
    assert stored == pytest.approx(mass / 2 * 9.81 * stiff.diameter / 2, rel=1e-3)
    soft = scene(StabilityBed(young=1e4))
    assert theory.deepest_overlap(soft, 64) == pytest.approx(3 * theory.overlap_at_rest(soft, 64))


def test_the_limits_of_the_checks_are_those_of_the_theory():
    bed = StabilityBed(young=5e3)
    assert theory.overlap_at_rest(scene(bed), bed.number) > OVERLAP_AT_REST_MAX
    assert theory.free_fall_limit(scene(StabilityBed()), 1e-3).value == pytest.approx(
        FREE_FALL_SHARE_MAX * math.sqrt(2 * 5e-3 / 9.81)
    )
    assert theory.density_limit(0.2).share == pytest.approx(2.0)
    still = theory.gas_step_limit(scene(StabilityBed(velocity=0.0)), 1e-3)
    assert still.formula.endswith("sqrt(2 cell / g)")
    fast = theory.gas_step_limit(scene(StabilityBed(velocity=5.0)), 1e-3)
    assert fast.share == pytest.approx(5.0 / 0.4 * 1e-3 / 5e-3)
    assert GAS_CELL_MAX == 0.5


def test_a_layer_whose_lattice_is_higher_than_the_box_is_refused(tmp_path):
    # 17 columns and 51 rows of 1.15 diameters; more would silently not be there
    assert loaded(StabilityBed(number=17 * 51), tmp_path)
    with pytest.raises(CaseError, match="particles.number.*take at most"):
        loaded(StabilityBed(number=17 * 51 + 1), tmp_path)


def test_what_must_be_carried_follows_from_the_motion():
    times_s = np.linspace(0, 0.1, 21)
    for carried in (0.0, 1.0, 2.5):
        heights = 0.01 + 0.3 * times_s + (carried - 1) * 9.81 / 2 * times_s**2
        series = pd.DataFrame({"time_s": times_s, "mean_height_m": heights})
        assert momentum(series) == pytest.approx(carried)


def test_one_particle_or_few_may_have_any_gas_cell(tmp_path):
    assert loaded(StabilityBed(number=1, cell=20), tmp_path)


def made_series(**columns):
    """bed_series.csv of a bed at rest, with some columns changed."""
    n = 10
    table = {
        "time_s": np.linspace(0.006, 0.06, n), "pressure_drop_Pa": 0.0, "weight_on_gas_1": 0.25,
        "weight_on_floor_1": 0.7, "weight_on_sides_1": 0.05, "mean_height_m": 0.007, "kinetic_energy_J": 0.0,
        "particles_1": 300, "voidage_clips_1": 0, "volume_balance_1": 1e-9, "exchange_error_1": 1e-16,
        "largest_overlap_1": 0.01,
    }  # fmt: skip
    return pd.DataFrame(table | columns)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"particles_1": [300] * 9 + [299]}, "lost particles"),
        ({"voidage_clips_1": 1}, "raised voidage"),
        ({"kinetic_energy_J": 1e-6}, "kinetic energy"),
        ({"weight_on_floor_1": 0.5}, "weight carried"),
        ({"largest_overlap_1": 0.2}, "deepest overlap"),
        ({"mean_height_m": 0.005}, "mean height"),
        ({"weight_on_gas_1": 0.35, "weight_on_floor_1": 0.6}, "weight on the gas"),
        ({"volume_balance_1": 1e-3}, "gas balance"),
        ({"exchange_error_1": 1e-6}, "exchange"),
        ({"pressure_drop_Pa": math.nan, "mean_height_m": math.nan}, "weight carried"),
    ],
)
def test_whatever_is_wrong_with_a_bed_is_seen(columns, said):
    case = case_of(StabilityBed())
    good = observe(case, made_series())
    expected = Expected(overlap=0.01, reference="x")
    assert judge(checks(good, expected, good)).outcome == STABLE
    found = judge(checks(observe(case, made_series(**columns)), expected, good))
    assert found.outcome == INACCURATE and said in found.quantity


def test_spheres_that_collide_start_apart_and_meet_at_all_parts_of_a_step():
    one = Collision(1e6, 1e-4, 0.1, 5e-4)
    left, right = pairs(one)[::2], pairs(one)[1::2]
    gaps = right[:, 0] - left[:, 0] - left[:, 4]
    assert (gaps > 0).all() and (left[:, 1] == right[:, 1]).all()
    assert gaps - gaps[0] == pytest.approx(np.arange(8) / 8 * 0.1 * 1e-4)
    assert left[:, 2] - right[:, 2] == pytest.approx(0.1)


def test_a_setting_that_hangs_is_ended_with_all_that_it_started(tmp_path):
    noted = tmp_path / "pid"

    def hang():
        child = subprocess.Popen(["sleep", "600"], preexec_fn=processes._end_with_parent)
        noted.write_text(str(child.pid))
        child.wait()

    assert limited(hang, 2.0).outcome == HUNG
    for _ in range(100):
        if not Path(f"/proc/{noted.read_text()}").exists():
            break
        time.sleep(0.1)
    assert not Path(f"/proc/{noted.read_text()}").exists()


def test_a_setting_that_breaks_is_a_verdict_and_a_users_error_is_told():
    assert "code 3" in limited(lambda: os._exit(3), 60).reason
    broken = limited(lambda: 1 / 0, 60)
    assert broken.outcome == CRASHED and "ZeroDivisionError" in broken.reason

    def absent():
        raise UserError("the program liggghts is not installed")

    with pytest.raises(UserError, match="not installed"):
        limited(absent, 60)


def setting(name, run, group="made up", inputs="1", **more):
    """A setting that does what it is told."""
    return StabilitySetting(group, name, {"x_1": 1.0}, Limit("x [1]", 2.0, "x < 2", 1.0), run, inputs, **more)


def noting(file, verdict):
    """What a setting runs: notes each call in a file, and gives a verdict."""

    def run(folder, known):
        folder.mkdir(parents=True)
        with file.open("a") as stream:
            stream.write("called\n")
        return verdict

    return run


def test_a_study_goes_on_after_failures_and_does_nothing_twice(tmp_path):
    notes = tmp_path / "notes"
    good = Verdict(STABLE, observed={"a_1": 1.0})
    settings = [
        setting("fails", lambda folder, known: 1 / 0),
        setting("works", noting(notes, good)),
        setting("needs", lambda folder, known: Verdict(STABLE, value=known["works"]["a_1"]), needs="works"),
    ]
    source = tmp_path / "source"
    source.write_text("one")
    sources, said = {"made up": [source]}, []
    table = run_study(settings, tmp_path / "study", sources, said.append)
    assert list(table["outcome"]) == [CRASHED, STABLE, STABLE] and table["value"].iloc[2] == 1.0
    assert list(table["over_limit_1"]) == [0.5] * 3
    assert len(said) == 3 and "3 of 3" in said[-1] and "left" in said[-1]
    assert (tmp_path / "study" / "work").exists() and not (tmp_path / "study" / "work" / "works").exists()
    again = run_study(settings, tmp_path / "study", sources, said.append)
    pd.testing.assert_frame_equal(again, table)
    assert notes.read_text().count("called") == 1
    run_study([replace(settings[1], inputs="2")], tmp_path / "study", sources, said.append)
    source.write_text("two")
    run_study([settings[1]], tmp_path / "study", sources, said.append)
    assert notes.read_text().count("called") == 3


def test_settings_are_chosen_with_what_they_are_compared_with():
    settings = [
        setting("base", None), setting("other", None, reduced=True, needs="base"),
        setting("alone", None, group="second", reduced=True), setting("long", None),
    ]  # fmt: skip
    assert [item.name for item in chosen(settings, [], True)] == ["base", "other", "alone"]
    assert [item.name for item in chosen(settings, ["second"], False)] == ["alone"]
    with pytest.raises(UserError, match="no group third: take one of made up, second"):
        chosen(settings, ["third"], False)


def test_the_study_has_what_was_asked_for():
    settings = [*chain_settings(), *bed_settings()]
    names = [item.name for item in settings]
    assert len(set(names)) == len(names)
    assert {item.needs for item in settings} - {""} <= set(names)
    shares = [item.limit.share * 0.2 for item in settings if item.group == "dem_step"]
    assert min(shares) < 0.011 and max(shares) > 1.4
    young = {item.values["young_Pa"] for item in settings if item.group == "dem_step"}
    assert min(young) == 1e4 and max(young) == 1e9
    assert {item.values["ranks_1"] for item in settings if item.group == "ranks"} == {1, 2, 4}
    assert {item.values["model"] for item in settings if item.group == "chain steps"} == {
        *("static", "dynamic", "velocity_class", "jump", "recurrence")
    }
    off = [item for item in settings if item.guards != "on"]
    assert all(item.name.removesuffix(", guard off") in names for item in off) and len(off) > 3


def test_maps_are_drawn_of_whatever_was_tried(tmp_path):
    outcomes = itertools.cycle([STABLE, INACCURATE, REFUSED, DIVERGED])
    settings = [*chain_settings(), *bed_settings()]
    rows = [row_of(item, Verdict(next(outcomes)), 1.0) for item in settings]
    draw_maps(pd.DataFrame(rows), tmp_path)
    made = {file.name for file in tmp_path.iterdir()}
    assert made == {f"{name}{form}" for name in ("steps", "gas_steps", "others", "chains")
                    for form in (".png", ".pdf", ".csv")}  # fmt: skip
    draw_maps(pd.DataFrame(rows[:5]), tmp_path / "some")
    assert {file.stem for file in (tmp_path / "some").iterdir()} == {"chains"}
