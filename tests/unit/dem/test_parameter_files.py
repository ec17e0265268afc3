# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameter files of both solvers: written together, left alone where nothing changed, or not at all."""

import pytest

from bedchain.dem import parameter_files
from bedchain.dem.parameter_files import write_parameters
from bedchain.errors import CaseError, UserError
from made.case_text import END, changed_case


def times(folder):
    return {file.name: file.stat().st_mtime_ns for file in folder.iterdir()}


def test_both_files_are_written_and_equal_ones_keep_their_time(tmp_path, capsys):
    folder = tmp_path / "results"
    write_parameters(changed_case(tmp_path), folder)
    assert capsys.readouterr().out.startswith("u_mf about")
    before = times(folder)
    assert set(before) == {"parameters.lig", "caseParameters"}
    assert (
        "variable diameter equal 0.001  # [m] particles.diameter_m\n"
        in (folder / "parameters.lig").read_text()
    )
    assert "diameter 0.001; // [m] particles.diameter_m\n" in (folder / "caseParameters").read_text()
    # the end of the run is no number of the solvers' files
    write_parameters(changed_case(tmp_path, (END, "  end_s: 6.0")), folder)
    assert times(folder) == before
    write_parameters(changed_case(tmp_path, ("number: 7200", "number: 7000")), folder)
    assert times(folder)["parameters.lig"] != before["parameters.lig"]


def test_a_bad_case_or_a_full_disk_leaves_no_file(tmp_path, monkeypatch):
    with pytest.raises(CaseError, match="seed: 4 is not above 10000"):
        write_parameters(changed_case(tmp_path, ("seed: 15485863", "seed: 4")), tmp_path / "bad")
    assert not (tmp_path / "bad").exists()
    monkeypatch.setattr(parameter_files, "run_bytes", lambda case: 10**18)
    with pytest.raises(UserError, match="free some space"):
        write_parameters(changed_case(tmp_path), tmp_path / "full")
    assert not list((tmp_path / "full").iterdir())


def test_a_bed_too_large_for_the_memory_leaves_no_file(tmp_path):
    large = ("number: 7200", "number: 100000000\n  diameter_m: 5.0e-6")
    small = tmp_path / "small"
    small.mkdir()
    file = changed_case(small, large, (END, "  allow_unstable_step: true\n" + END))
    text = file.read_text()
    file.write_text(text + "contact: {young_modulus_Pa: 1.0e+7}\ngas: {viscosity_Pa_s: 1.0e-9}\n")
    with pytest.raises(UserError, match="the simulation needs about|learning the chains needs about"):
        write_parameters(file, tmp_path / "large")
    assert not (tmp_path / "large").exists()
