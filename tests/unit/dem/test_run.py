# SPDX-License-Identifier: GPL-3.0-or-later
"""A run in segments with solvers that write what the real ones would; those are in tests/solver."""

import json

import pytest

from bedchain.dem import run as dem_run
from bedchain.dem.parameter_files import write_parameters
from bedchain.dem.segments import read_parameters
from bedchain.errors import UserError
from made import ROOT
from made.case_text import changed_case


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

    def prepare_gas(gas, case_parameters, previous, settings):
        gas.mkdir()
        (gas / "settings.json").write_text(json.dumps(settings))

    def run_logged(command, log, progress):
        settings = json.loads((log.parent / "gas" / "settings.json").read_text())
        times.append(settings["start_time"])
        if settings["start_time"] in broken:
            raise UserError("bedFoam ended with code 1")
        for step in range(
            round(settings["start_time"] / step_s), round(settings["end_time"] / step_s) + 1, frame_steps
        ):
            (log.parent / f"frame_{step}.bin").write_bytes(b"x")
        rows = f"time_s,mean_height_m\n{settings['end_time']},0.1\n"
        (log.parent / "gas" / "bed_series.csv").write_text(rows)
        progress("totals simulated 0.5 wall 10 dem 7 exchange 1 gas 2")

    monkeypatch.setattr(dem_run, "prepare_gas", prepare_gas)
    monkeypatch.setattr(dem_run, "run_logged", run_logged)
    monkeypatch.setattr(dem_run, "run_deck", lambda deck, variables, log, ranks: times.append(deck.name))
    return times, broken


def test_a_run_settles_then_goes_on_segment_by_segment_and_does_nothing_twice(folder, starts):
    times, _ = starts
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert times == ["in.settle", 0.0, 0.5]
    manifest = json.loads((folder / "dem.json").read_text())
    assert len(manifest["frames"]) == 41 and [segment["end_s"] for segment in manifest["segments"]] == [
        0.5,
        1.0,
    ]
    assert (folder / "bed_series.csv").read_text() == "time_s,mean_height_m\n0.5,0.1\n1.0,0.1\n"
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert len(times) == 3
    # a longer run goes on, a shorter one leaves out what is beyond
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    assert times[3:] == [1.0]
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    assert len(json.loads((folder / "dem.json").read_text())["segments"]) == 1


def test_a_segment_that_fails_leaves_those_before_and_says_where_to_go_on(folder, starts):
    times, broken = starts
    broken.add(0.5)
    with pytest.raises(UserError, match="code 1\nlast good state: .*segment_0001/particles.restart"):
        dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert not (folder / "dem.json").exists()
    broken.clear()
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert times == ["in.settle", 0.0, 0.5, 0.5]


def test_another_number_begins_anew(folder, starts, tmp_path):
    times, _ = starts
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    write_parameters(changed_case(tmp_path, ("number: 7200", "number: 7000")), folder)
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    assert times == ["in.settle", 0.0] * 2


@pytest.mark.parametrize(("end", "segment", "message"), [(0.51, 0.5, "--end"), (1.0, 0.0, "--segment")])
def test_times_must_be_whole_frames(folder, end, segment, message):
    with pytest.raises(UserError, match=f"{message} must be a whole number of frame intervals, 0.025 s each"):
        dem_run.run_dem(folder, end, segment, 1)


def test_a_repeat_starts_where_a_segment_ends_and_ends_later(folder, starts):
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    with pytest.raises(UserError, match="no segment of the run ends at 0.75 s"):
        dem_run.repeat_dem(folder, 0.75, 1.0, 0.5, 1, 1)
    with pytest.raises(UserError, match="--end, 0.5 s, must be after --start, 1 s"):
        dem_run.repeat_dem(folder, 1.0, 0.5, 0.5, 1, 1)


def test_a_missing_solver_is_named(folder, tmp_path):
    (tmp_path / "bedFoam").unlink()
    with pytest.raises(UserError, match="bedFoam missing: run snakemake"):
        dem_run.input_files(folder)
