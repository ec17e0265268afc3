# SPDX-License-Identifier: GPL-3.0-or-later
"""Two fluids by OpenFOAM against closed forms: granular cooling, a fixed bed, and segments that go on."""

import re

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.case.parameters import openfoam_text, solver_parameters
from bedchain.case.schema import load_schema
from bedchain.case.two_fluid import two_fluid_case
from bedchain.dem.processes import run_logged
from bedchain.dem.two_fluid import prepare, read_run, run_two_fluid
from bedchain.dem.two_fluid_balance import carried
from bedchain.dem.two_fluid_fields import read_scalars
from bedchain.files import write_text
from bedchain.physics.fluidization import ergun_gradient
from made import ROOT

RESTITUTION, DIAMETER, DENSITY, THETA, END_S = 0.8, 1e-3, 2600.0, 0.01, 0.05
COOLING_TOLERANCE = 0.015  # a step is 3 % of the shortest time of cooling, with Euler's method
CARRIED_TOLERANCE = 0.01  # of Ergun's pressure drop and the weight; a frame scatters by 2 %
REST_TOLERANCE = 0.05  # of the weight: six frames, viscous stress at the floor
LIMIT = 0.62  # of the packing, for the contact value of Sinclair and Jackson


@pytest.fixture
def case(monkeypatch):
    """A box of 2 x 4 cells."""
    monkeypatch.chdir(ROOT)
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    case["bed"] |= {"width_m": 0.02, "height_m": 0.04}
    case["particles"]["number"] = 100
    case["contact"]["restitution_1"] = RESTITUTION
    case["gas"]["superficial_velocity_m_s"] = 0.0
    case["time"] |= {"end_s": END_S, "segment_s": END_S, "gas_step_s": 1.25e-4}
    return two_fluid_case(case, 0.01)


def openfoam_case(folder, case, solids, gravity):
    """An OpenFOAM case with uniform solids."""
    folder.mkdir()
    write_text(folder / "caseParameters", openfoam_text(solver_parameters(case, load_schema())))
    prepare(folder, folder / "caseParameters", None, case, (0.0, case["time"]["end_s"]))
    gas = folder / "gas"
    for name, value in (("startSolids", solids), ("startGas", 1 - solids)):
        write_text(gas / name, f"internalField uniform {value};\n")
    settings = (gas / "segmentParameters").read_text()
    write_text(gas / "segmentParameters", re.sub("largest_solids .*;", f"largest_solids {LIMIT};", settings))
    for file, old, new in (
        ("constant/g", "-9.81", f"{-gravity}"),
        ("0/Theta.particles", "uniform 1e-4", f"uniform {THETA}"),
    ):
        text = (gas / file).read_text()
        assert old in text
        write_text(gas / file, text.replace(old, new))
    return gas


def cooled(solids, drag, seconds):
    """Granular temperature by the closed form: collisions, and drag where there is one."""
    contact = 1 / (1 - (solids / LIMIT) ** (1 / 3))
    loss = 8 * (1 - RESTITUTION**2) * solids * contact / (DIAMETER * np.sqrt(np.pi))
    start = np.sqrt(THETA)
    if drag == 0:
        return (start / (1 + loss * start * seconds / 2)) ** 2
    rate = 2 * drag / (solids * DENSITY)
    decay = np.exp(-rate * seconds / 2)
    return (rate * start * decay / (rate + loss * start * (1 - decay))) ** 2


@pytest.mark.parametrize("solids", [0.1, 0.3])
def test_granular_temperature_cools_by_collisions(case, tmp_path, solids):
    case["gas"] |= {"density_kg_m3": 1e-6, "viscosity_Pa_s": 1e-9}
    gas = openfoam_case(tmp_path / "run", case, solids, 0.0)
    run_logged(["twoPhaseEulerFoam", "-case", str(gas)], tmp_path / "log")
    theta = read_scalars(gas / f"{END_S:g}" / "Theta.particles", 8)
    tau = {0.1: 56.09e-3, 0.3: 8.818e-3}[solids]
    assert cooled(solids, 0, END_S) == pytest.approx(THETA / (1 + END_S / tau) ** 2, rel=1e-3)
    np.testing.assert_allclose(theta, cooled(solids, 0, END_S), rtol=COOLING_TOLERANCE)


def test_granular_temperature_cools_by_collisions_and_drag(case, tmp_path):
    solids = 0.3
    gas = openfoam_case(tmp_path / "run", case, solids, 0.0)
    run_logged(["twoPhaseEulerFoam", "-case", str(gas)], tmp_path / "log")
    theta = read_scalars(gas / f"{END_S:g}" / "Theta.particles", 8)
    drag = 150 * solids**2 * 1.8e-5 / ((1 - solids) * DIAMETER**2)  # Ergun without slip
    np.testing.assert_allclose(theta, cooled(solids, drag, END_S), rtol=COOLING_TOLERANCE)


def test_ergun_s_pressure_drop_and_the_bed_s_weight(case, tmp_path):
    # gravity such that the gas just carries uniform solids, too loose for friction: its pressure drop is
    # Ergun's and the weight
    solids, speed, frames = 0.45, 0.3, [0.075, 0.1, 0.125, 0.15]
    case["bed"]["height_m"] = 0.08
    gravity = ergun_gradient(1 - solids, DIAMETER, 1.2, 1.8e-5, speed) / (solids * (DENSITY - 1.2))
    case["gas"]["superficial_velocity_m_s"] = speed
    case["time"] |= {"ramp_s": 0.005, "end_s": frames[-1], "segment_s": frames[-1]}
    gas = openfoam_case(tmp_path / "run", case, solids, gravity)
    run_logged(["twoPhaseEulerFoam", "-case", str(gas)], tmp_path / "log")
    pressure, share = (
        np.mean([rows(gas / f"{time_s:g}" / name) for time_s in frames], axis=0)
        for name in ("p", "alpha.particles")
    )
    # between the middles of cells: at the inlet the solver gives the pressure of the lowest cell
    gradients, between = -np.diff(pressure)[1:] / 0.01, (share[1:-1] + share[2:]) / 2
    ergun = [ergun_gradient(1 - value, DIAMETER, 1.2, 1.8e-5, speed) for value in between]
    weight = gravity * (between * DENSITY + (1 - between) * 1.2)
    assert gradients.sum() == pytest.approx(sum(ergun), rel=CARRIED_TOLERANCE)
    assert gradients.sum() == pytest.approx(weight.sum(), rel=CARRIED_TOLERANCE)


def rows(file):
    """Means over the two cells of each row of eight."""
    return read_scalars(file, 16).reshape(8, 2).mean(axis=1)


def test_a_run_goes_on_after_its_last_segment_and_its_flow_carries_its_solids(case, tmp_path):
    case["gas"]["superficial_velocity_m_s"] = 1.5
    case["time"] |= {"end_s": 0.1, "segment_s": 0.05, "ramp_s": 0.02}
    write_text(tmp_path / "caseParameters", openfoam_text(solver_parameters(case, load_schema())))
    run_two_fluid(tmp_path, case)
    records = sorted(tmp_path.glob("segment_*/segment.json"))
    times = [file.stat().st_mtime_ns for file in records]
    case["time"]["end_s"] = 0.15
    run_two_fluid(tmp_path, case)
    assert [file.stat().st_mtime_ns for file in records] == times
    run = read_run(tmp_path)
    flow, series = run.flow, run.series
    np.testing.assert_allclose(flow.times_s, 0.025 * np.arange(1, 7))
    shares = carried(run.balance)
    assert run.balance["weight_Pa"].max() == pytest.approx(run.balance["weight_Pa"].min(), rel=1e-3)
    # a thin layer in a blast: gas and granular pressure carry it or speed it up, friction has no part
    assert abs(shares["rest"]) < REST_TOLERANCE
    assert series["solids_drift_1"].abs().max() < 1e-4 and run.cpu_s_per_s > 0
    gain = np.zeros_like(flow.solids)
    gain[:, :, :-1] -= flow.right
    gain[:, :, 1:] += flow.right
    gain[:, :-1] -= flow.up
    gain[:, 1:] += flow.up
    change = gain[1:] * 0.025 / (0.01**2 * case["bed"]["thickness_m"])
    # the top row may lose solids to the outside
    np.testing.assert_allclose(np.diff(flow.solids, axis=0)[:, :-1], change[:, :-1], atol=1e-4)
