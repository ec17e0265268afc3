# SPDX-License-Identifier: GPL-3.0-or-later
"""Small cases: their inputs, and what the solvers are asked to run."""

import numpy as np
import pytest

from bedchain.dem import small_cases
from bedchain.dem.segments import read_parameters
from bedchain.dem.small_cases import Setup, run_gas, run_particles, write_inputs
from bedchain.work_folders import work_folder
from made import ROOT
from made.synthetic_bed import write_binary_dump

SECTIONS = {"bed": {"width_m": 0.02, "height_m": 0.05}, "time": {"frame_interval_s": 2e-3}}
SPHERES = np.array([[0.005, 0.01, 0.0, 0.0, 1e-3], [0.015, 0.01, 0.1, 0.0, 1e-3]])


@pytest.fixture
def setup(tmp_path, monkeypatch):
    """Two spheres, one number that no case file has and one that the case would give otherwise."""
    monkeypatch.chdir(ROOT)
    return Setup(tmp_path / "small", SECTIONS, SPHERES, {"skin": 0.01, "gravity": 0.0})


def test_inputs_are_those_of_the_case_with_the_numbers_of_the_check(setup):
    work_folder(setup.folder)
    (setup.folder / "old").touch()
    given = write_inputs(setup)
    assert not (setup.folder / "old").exists()
    written = read_parameters(setup.folder / "parameters.lig")
    assert written["skin"] == given["skin"] == 0.01
    assert (written["gravity"], written["frozen"], written["number"]) == (0, 0, 2)
    assert written["width"] == 0.02 and "2 atoms" in (setup.folder / "particles.data").read_text()


def test_particles_alone_run_for_whole_steps(setup, monkeypatch):
    calls = []

    def run_deck(deck, variables, log):
        calls.append((deck.name, variables["steps"]))
        for step in (0, variables["steps"]):
            table = np.column_stack([[2, 1], SPHERES[::-1, :4] + step, [0, 0]])
            write_binary_dump(variables["output"] / f"frame_{step}.bin", step, table, [(0, 1)] * 3)

    monkeypatch.setattr(small_cases, "run_deck", run_deck)
    frames = run_particles(setup, 4e-3)
    assert calls == [
        ("in.contact", round(4e-3 / read_parameters(setup.folder / "parameters.lig")["dem_step"]))
    ]
    assert frames.shape == (2, 2, 6) and (frames[0, :, 1] == SPHERES[:, 0]).all()


def test_gas_runs_on_the_project_s_own_case_with_the_changes_asked_for(setup, monkeypatch, tmp_path):
    programs = []

    def run_logged(command, log):
        programs.append(command[0])
        (setup.folder / "gas" / "bed_series.csv").write_text("time_s,pressure_drop_Pa\n0.1,5\n")

    monkeypatch.setattr(small_cases, "run_logged", run_logged)
    table = run_gas(setup, tmp_path / "bedFoam", 4e-3, "constant 1.5", row_every=3, tight=True, slip=True)
    assert programs == ["blockMesh", str(tmp_path / "bedFoam")] and table["pressure_drop_Pa"].tolist() == [5]
    gas = setup.folder / "gas"
    changes = {"constant/gasProperties": "constant 1.5;", "system/fvSolution": "1e-13", "0/U": "type slip"}
    for name, text in changes.items():
        added = (gas / name).read_text().splitlines()[-1]
        assert (
            text in added and text not in (ROOT / "openfoam_case" / name.replace("0/", "0.orig/")).read_text()
        )
    settings = (gas / "segmentParameters").read_text()
    assert "end_time 0.004;" in settings and "row_every 3;" in settings
