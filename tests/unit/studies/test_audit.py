# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene audit: numbers against theory found another way, decisions that flip at the thresholds."""

import math
from dataclasses import replace

import pandas as pd
import pytest
from scipy.optimize import brentq

from audit_scene import audit_scene
from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from bedchain.physics import scene_numbers
from bedchain.studies import audit
from made import ROOT


def decision(scene, physics):
    rows = audit.audit(scene).set_index("physics")
    assert rows.index.is_unique
    return rows.loc[physics, "decision"]


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
    tenth = brentq(
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


def test_the_table_and_the_log_of_the_stage(paper, tmp_path, caplog):
    table = tmp_path / "audit.csv"
    with caplog.at_level("INFO", "bedchain"):
        audit_scene(paper, table)
    rows = pd.read_csv(table)
    assert list(rows.columns) == [
        *("physics", "number", "symbol", "value", "threshold", "source", "decision", "built", "agrees"),
    ]
    judged, expected = rows[rows["decision"] != "expect"], rows[rows["decision"] == "expect"]
    assert (expected["physics"] == "expected of the bed: slow bubbles").all()
    heights = expected.set_index("number")["value"]
    assert heights["mean particle height [m]"] == pytest.approx(0.196, rel=3e-3)
    assert len(caplog.messages) == len(judged) + len(expected) + 1
    assert "keep gas flow: drag over weight, forced or own 2.92, threshold 0.1" in caplog.messages


def test_a_disagreement_is_warned_of(paper, tmp_path, caplog):
    paper["gas"]["superficial_velocity_m_s"] = 8.0
    with caplog.at_level("WARNING", "bedchain"):
        audit_scene(paper, tmp_path / "audit.csv")
    assert any(
        "particles leaving with the gas is needed and not simulated" in said for said in caplog.messages
    )


DRUM = ROOT / "cases" / "drum" / "case.yaml"


def test_dust_in_a_drum_needs_the_gas_and_the_audit_says_that_it_is_not_there():
    case = load_case(DRUM)
    case["particles"]["diameter_m"] = 1e-4
    case["bed"]["thickness_m"] = 1e-4
    rows = audit.audit(scene_of(case)).set_index("physics")
    assert list(rows.loc["gas flow", ["decision", "built", "agrees"]]) == ["keep", "no", "no"]


def test_the_audit_says_which_kernel_smooths_the_voidage(scene):
    physics = "kernel wider than the hat of one gas cell"
    coarse = replace(scene, gas=True, smoothing=3e-3, cell=2.13e-3)
    assert decision(coarse, physics) == "drop"
    assert decision(replace(coarse, cell=2.12e-3), physics) == "keep"
    assert (audit.audit(coarse).set_index("physics").loc[physics, "agrees"]) == "yes"
