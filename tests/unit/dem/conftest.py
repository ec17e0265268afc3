# SPDX-License-Identifier: GPL-3.0-or-later
"""A case's folder, and solvers that write what the real ones would."""

import json
from pathlib import Path

import pytest

from bedchain.dem import run as dem_run
from bedchain.dem import segment_run
from bedchain.dem.parameter_files import write_parameters
from bedchain.dem.segments import read_parameters
from bedchain.errors import UserError
from made import ROOT
from made.case_text import changed_case
from made.solver_files import write_dump, write_gas, write_restart, write_series


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A case's folder with its parameters, in the repository; a solver that is a file."""
    monkeypatch.chdir(ROOT)
    write_parameters(changed_case(tmp_path), tmp_path / "results")
    (tmp_path / "bedFoam").touch()
    monkeypatch.setattr(dem_run, "SOLVER", tmp_path / "bedFoam")
    return tmp_path / "results"


@pytest.fixture
def starts(folder, monkeypatch):
    """Times at which the solver was started; it fails at those in ``broken``."""
    times, broken = [], set()
    parameters = read_parameters(folder / "parameters.lig")
    step_s, frame_steps = float(parameters["dem_step"]), int(parameters["frame_steps"])
    row_s = segment_run.ROW_EVERY * float(parameters["gas_step"])

    def number_of_particles():
        return int(read_parameters(folder / "parameters.lig")["number"])

    def prepare_gas(gas, case_parameters, previous, settings):
        gas.mkdir()
        (gas / "settings.json").write_text(json.dumps(settings))

    def run_logged(command, log, progress, silence_s):
        settings = json.loads((log.parent / "gas" / "settings.json").read_text())
        number = number_of_particles()
        times.append(settings["start_time"])
        if settings["start_time"] in broken:
            raise UserError("bedFoam ended with code 1")
        for step in range(
            round(settings["start_time"] / step_s), round(settings["end_time"] / step_s) + 1, frame_steps
        ):
            write_dump(log.parent / f"frame_{step}.bin", step, number)
        write_gas(log.parent / "gas", settings["end_time"])
        write_series(log.parent / "gas/bed_series.csv", settings["start_time"], settings["end_time"], row_s)
        # what it leaves follows from what it went on from
        word = Path(settings["restart"]).read_bytes()[:8] + b"+"
        write_restart(log.parent / "particles.restart", number, word=word[-8:])
        progress("totals simulated 0.5 wall 10 dem 7 exchange 1 gas 2")

    def run_deck(deck, variables, log, ranks, silence_s):
        times.append(deck.name)
        write_restart(variables["output"] / "particles.restart", number_of_particles())

    monkeypatch.setattr(segment_run, "prepare_gas", prepare_gas)
    monkeypatch.setattr(segment_run, "run_logged", run_logged)
    monkeypatch.setattr(segment_run, "run_deck", run_deck)
    return times, broken
