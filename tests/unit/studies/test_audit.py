# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene audit: numbers against theory found another way, decisions that flip at the thresholds."""

import copy
import math
from dataclasses import replace

import pandas as pd
import pytest

from audit_scene import audit_scene
from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from bedchain.errors import UserError
from bedchain.physics import scene_numbers
from bedchain.studies import audit
from bedchain.studies.verification.laws import (
    Suspension,
    drag_coefficient,
    ergun_gradient,
    minimum_fluidization,
    wen_yu_beta,
)
from made import ROOT

SAME = 1e-9  # relative, of two ways to one root


@pytest.fixture(scope="module")
def case():
    return load_case(ROOT / "cases" / "paper" / "case.yaml")


@pytest.fixture(scope="module")
def scene(case):
    return scene_of(case)


@pytest.fixture(scope="module")
def spheres():
    return Suspension(1e-3, 2600, 1.2, 1.8e-5)


def bisect(rising, low, high):
    """Root of a rising function, by halving 200 times."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < 0 else (low, middle)
    return low


def decision(scene, physics):
    rows = audit.audit(scene).set_index("physics")
    assert rows.index.is_unique
    return rows.loc[physics, "decision"]


def test_archimedes_number_of_the_paper_by_hand(scene):
    assert scene_numbers.archimedes(scene) == pytest.approx(1.2 * 2598.8 * 9.81 * 1e-9 / 3.24e-10, rel=SAME)


def test_voidage_of_the_slab_by_hand(scene):
    # discs that cover 82 % of the area, as spheres in a slab of one diameter
    share = 0.82 / (math.pi / 4) * math.pi / 6
    assert scene.voidage == pytest.approx(1 - share, rel=SAME)


def test_ergun_velocity_carries_the_bed(scene, spheres):
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(
        minimum_fluidization(spheres, scene.voidage), rel=1e-8
    )
    weight = (1 - scene.voidage) * 2598.8 * 9.81
    root = bisect(lambda speed: ergun_gradient(spheres, scene.voidage, speed) - weight, 0, 10)
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(root, rel=SAME)
    there = replace(scene, velocity=scene_numbers.ergun_velocity(scene))
    assert scene_numbers.pressure_share(there) == pytest.approx(1, rel=SAME)


def test_the_design_s_velocities_of_fluidization(scene):
    # 0.77 m/s in the slab of one diameter, as design.md states
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(0.77, abs=0.005)
    # Wen and Yu's own balance: Re^2 24.5 + 1652 Re = Ar
    re = scene_numbers.reynolds(scene, scene_numbers.wen_yu_velocity(scene))
    assert re**2 / 0.0408 + 2 * 33.7 / 0.0408 * re == pytest.approx(scene_numbers.archimedes(scene), rel=SAME)


@pytest.mark.parametrize("diameter", [1e-6, 1e-4, 1e-3, 2e-2])
def test_terminal_velocity_balances_the_drag_of_one_sphere(scene, diameter):
    one = Suspension(diameter, 2600, 1.2, 1.8e-5)
    dilute = 1 - 1e-12

    def surplus(speed):
        return drag_coefficient(wen_yu_beta, one, dilute, speed) * speed - one.weight

    speed = scene_numbers.terminal_velocity(replace(scene, diameter=diameter))
    # at 2 cm Newton's law: the tolerance is that of 1 - 1e-12 in double precision
    assert speed == pytest.approx(bisect(surplus, 0, 1e3), rel=1e-4)


def test_stokes_limit_of_the_terminal_velocity(scene):
    small = replace(scene, diameter=1e-6)
    stokes = 2598.8 * 9.81 * 1e-12 / (18 * 1.8e-5)
    assert scene_numbers.terminal_velocity(small) == pytest.approx(stokes, rel=1e-3)


def test_air_s_properties(scene):
    assert scene_numbers.sound_velocity(scene) == pytest.approx(343, abs=1.5)
    assert scene_numbers.free_path(scene) == pytest.approx(66e-9, abs=2e-9)


def test_collision_of_hertz_by_hand(scene):
    modulus, mass = 7.7e5 / 1.82, 2600 * math.pi / 12 * 1e-9
    speed = math.sqrt(9.81e-3)
    expected = 2.868 * (mass**2 / (2.5e-4 * modulus**2 * speed)) ** 0.2
    assert scene_numbers.contact_duration(scene) == pytest.approx(expected, rel=SAME)


def test_thresholds_that_are_derived(scene):
    # a small share of what the physics would change; the thresholds are these shares, rounded
    rows = audit.audit(scene).set_index("number")["threshold"]
    assert 0.15 * rows["Reynolds number at U"] ** 0.687 == pytest.approx(0.05, rel=0.01)
    assert (1 + 0.2 * rows["Mach number"] ** 2) ** 2.5 - 1 == pytest.approx(0.05, rel=0.1)
    assert 2.514 * rows["Knudsen number"] == pytest.approx(0.025, rel=0.01)
    sand = replace(scene, diameter=1e-4, density=2650)
    assert scene_numbers.archimedes(sand) == pytest.approx(rows["Archimedes number"], rel=0.1)


def test_history_force_of_a_particle_that_speeds_up_evenly(scene):
    mu, density, diameter = 1.8e-5, 1.2, 1e-3
    relaxation = scene.density * diameter**2 / (18 * mu)
    memory = 2 * math.sqrt(relaxation)  # Basset's integral of d(tau) / sqrt(t - tau), 0 to t
    basset = 1.5 * diameter**2 * math.sqrt(math.pi * density * mu) * memory
    stokes = 3 * math.pi * mu * diameter * relaxation
    rows = audit.audit(scene).set_index("physics")["value"]
    assert rows["history force"] == pytest.approx(basset / stokes, rel=1e-6)


def test_wall_share_of_janssen():
    # the mean of exp(-j z) over the depth is what the floor carries
    steps = 100_000
    floor = sum(math.exp(-2.0 * (step + 0.5) / steps) for step in range(steps)) / steps
    assert audit.wall_share(2.0) == pytest.approx(1 - floor, rel=1e-8)
    assert audit.wall_share(0.0) == 0
    assert audit.wall_share(1e-4) == pytest.approx(0.5e-4, rel=1e-3)


@pytest.mark.parametrize("name", ["paper", "short", "mueller"])
def test_the_shipped_beds_are_built_as_the_audit_says(name):
    rows = audit.audit(scene_of(load_case(ROOT / "cases" / name / "case.yaml")))
    assert set(rows["decision"]) == {"keep", "drop"}
    assert (rows["agrees"] == "yes").all()
    assert rows["value"].notna().all() and (rows["value"] >= 0).all()
    assert rows["source"].str.contains(r"our choice|by definition|derived|transition in|chaotic").all()


def at_threshold(scene):
    """For each piece of physics: the key, and the value of it where the decision flips."""
    weight_scale = math.pi / 6 * (scene.density - scene.gas_density) * 9.81
    van_der_waals, water = 6.5e-20 * 1e-7 / (6 * 1.6e-19), 4 * math.pi * 0.072 * 1e-7
    return {
        "cohesion, van der Waals": ("diameter", (van_der_waals / weight_scale) ** (1 / 3)),
        "cohesion, condensed water": ("diameter", (water / weight_scale) ** (1 / 3)),
        "slip of the gas on particles": ("diameter", scene_numbers.free_path(scene) / 0.01),
        "particles leaving with the gas": ("velocity", scene_numbers.terminal_velocity(scene)),
        "turbulence in the pores": ("velocity", 300 * scene.voidage * 1.8e-5 / (1.2 * 1e-3)),
        "turbulence above the bed": ("thickness", 0.27 / (2 * 0.27 * 1.2 * 1.5 / (2300 * 1.8e-5) - 1)),
        "added mass": ("density", 1.2 / 0.02),
        "history force": ("density", 1.2 * 18 / (math.pi * 0.01)),
        "buoyancy in gas at rest": ("density", 120.0),
        "flow around each particle": ("cell", 1.63e-3),
        "third dimension": ("thickness", 2e-3),
        "compressibility of the gas, by velocity": (
            "velocity", 0.3 * scene_numbers.sound_velocity(scene) * scene.voidage,
        ),
        "compressibility of the gas, by pressure": (
            "depth", 0.05 * 101325 / ((1 - scene.voidage) * 2598.8 * 9.81),
        ),
    }  # fmt: skip


FLIPPING = sorted(at_threshold(scene_of(load_case(ROOT / "cases" / "paper" / "case.yaml"))))


@pytest.mark.parametrize("physics", FLIPPING)
def test_decisions_flip_at_the_threshold(scene, physics):
    key, value = at_threshold(scene)[physics]
    around = {
        decision(replace(scene, **{key: value * factor}), physics): factor for factor in (1 - 1e-6, 1 + 1e-6)
    }
    assert set(around) == {"keep", "drop"}
    rises = key in ("velocity", "thickness", "depth")
    assert around["keep"] == (1 + 1e-6 if rises else 1 - 1e-6)


def test_gas_that_does_next_to_nothing_is_dropped_with_all_that_belongs_to_it(scene):
    calm = replace(scene, fall=1e-3)  # particles that do not fall far
    tenth = bisect(
        lambda speed: scene_numbers.pressure_share(replace(scene, velocity=speed)) - 0.1, 1e-6, 1.0
    )
    for factor, expected in ((1.001, "keep"), (0.999, "drop")):
        rows = audit.audit(replace(calm, velocity=tenth * factor)).set_index("physics")
        assert rows.loc["gas flow", "decision"] == expected
        assert rows.loc["particles act on the gas", "decision"] == expected
        assert rows.loc["collisions", "decision"] == "keep"
        assert rows.loc["gas flow", "agrees"] == ("yes" if expected == "keep" else "no")


def test_walls_in_front_and_behind_count_only_where_the_gas_does_not_carry_the_bed(scene):
    name = "friction in front and behind"
    assert decision(scene, name) == "drop"
    assert decision(replace(scene, velocity=0.1), name) == "keep"
    assert decision(replace(scene, velocity=0.1, friction=1e-6), name) == "drop"


def test_rolling_resistance_is_built_by_its_key():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    case["contact"]["rolling_friction_1"] = 0.01
    rows = audit.audit(scene_of(case)).set_index("physics")
    assert rows.loc["rolling resistance", ["decision", "built", "agrees"]].tolist() == ["drop", "yes", "no"]


def test_the_table_and_the_log_of_the_stage(case, tmp_path, caplog):
    table = tmp_path / "audit.csv"
    with caplog.at_level("INFO", "bedchain"):
        audit_scene(case, table)
    rows = pd.read_csv(table)
    assert list(rows.columns) == [
        *("physics", "number", "symbol", "value", "threshold", "source", "decision", "built", "agrees"),
    ]
    assert len(caplog.messages) == len(rows)
    assert "keep gas flow: drag over weight, forced or own 2.92, threshold 0.1" in caplog.messages


def test_a_disagreement_is_warned_of(case, tmp_path, caplog):
    fast = copy.deepcopy(case)
    fast["gas"]["superficial_velocity_m_s"] = 8.0
    with caplog.at_level("WARNING", "bedchain"):
        audit_scene(fast, tmp_path / "audit.csv")
    assert any(
        "particles leaving with the gas is needed and not simulated" in said for said in caplog.messages
    )


def test_particles_lighter_than_the_gas_are_refused(case):
    light = copy.deepcopy(case)
    light["particles"]["density_kg_m3"] = 1.0
    with pytest.raises(
        UserError, match=r"particles.density_kg_m3 \(1\) is not above gas.density_kg_m3 \(1.2\)"
    ):
        scene_of(light)
