# SPDX-License-Identifier: GPL-3.0-or-later
"""The command ./run import: a case that loads, a name for it, and no file written over."""

import shutil
import subprocess
import sys

import pytest

from made import ROOT
from made.forms import moving, write_form
from write_case import name_of


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A folder with what the command reads of the project."""
    folder = tmp_path_factory.mktemp("project")
    (folder / "scripts").symlink_to(ROOT / "scripts")
    (folder / "cases").mkdir()
    for name in ("case.schema.yaml", "presets.yaml"):
        shutil.copy(ROOT / "cases" / name, folder / "cases")
    write_form("text", folder / "data", moving(n_frames=20, n_particles=60))
    return folder


def run(project, *words):
    command = [sys.executable, "scripts/write_case.py", *words]
    return subprocess.run(command, cwd=project, capture_output=True, text=True)


def test_a_case_is_written_once_and_loads(project):
    done = run(project, "data/frame_*.dump", "--name", "mine")
    assert done.returncode == 0, done.stderr
    assert "cases/mine/case.yaml is written" in done.stdout and "corrected by hand" not in done.stdout
    again = run(project, "data/frame_*.dump", "--name", "mine")
    assert again.returncode == 1 and "is there already: give another name by --name" in again.stderr


def test_frames_that_are_none_end_in_one_sentence(project):
    (project / "data" / "notes").write_text("nothing to see\n")
    done = run(project, "data/notes", "--name", "other")
    assert done.returncode == 1 and done.stderr.startswith("error: ") and done.stderr.count("\n") == 1
    assert not (project / "cases" / "other").exists()


@pytest.mark.parametrize(
    ("pattern", "name"),
    [
        ("/data/drum_*.vtk", "drum"),
        ("/data/run7/*.bin", "run7"),
        ("/1/2.txt", "imported"),
        ("a b.csv", "a_b"),
    ],
)
def test_names_of_cases(pattern, name):
    assert name_of(pattern) == name
