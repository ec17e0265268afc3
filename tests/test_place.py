# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of the folder, links to it, other folders and somebody's settings; nothing is installed."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

from made import ROOT
from made.workflow import ODD_NAME

NOBODY = 65534  # a user that exists on every Debian and owns nothing
REFUSED = ('a"b', "a$b", "a`b", "a\\b", "a:b", "a{b}", "a\nb", "a\tb")
FOREIGN = {
    *(
        "PYTHONPATH",
        "PYTHONHOME",
        "PYTHONSAFEPATH",
        "VIRTUAL_ENV",
        "CONDA_PREFIX",
        "LD_LIBRARY_PATH",
        "BASH_ENV",
    ),
    *("OMPI_COMM_WORLD_RANK", "PMIX_RANK", "FOAM_ETC", "FOAM_LIBBIN", "WM_PROJECT_DIR"),
    *("CONDA_PREFIX", "BASH_ENV", "MPI_BUFFER_SIZE"),
}
SECOND = 20  # a busy machine's: the set-up itself takes minutes


def run(*command: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, timeout=SECOND, **options
    )


def scripts_in(folder: Path) -> Path:
    """The shell scripts and lists of the set-up, and ./run, in a folder."""
    shutil.copytree(ROOT / "envs", folder / "envs")
    for name in ("run", "test"):
        shutil.copy(ROOT / name, folder)
    return folder


@pytest.mark.parametrize("script", ["run", "test"])
@pytest.mark.parametrize("name", REFUSED)
def test_a_folder_name_that_cannot_serve_is_refused_before_anything_is_installed(tmp_path, name, script):
    folder = scripts_in(tmp_path / name)
    outcome = run("sh", script, cwd=folder)
    assert outcome.returncode == 1
    assert outcome.stderr.startswith("setup: error: the name of this folder holds a character")
    assert "rename it" in outcome.stderr
    assert not (folder / ".setup").exists()


def test_other_folder_names_serve(tmp_path):
    folder = scripts_in(tmp_path / ODD_NAME)
    outcome = run("sh", "-euc", ". envs/common.sh; check_place", cwd=folder)
    assert (outcome.returncode, outcome.stdout, outcome.stderr) == (0, "", "")


def test_run_is_found_through_a_link_and_from_another_folder(tmp_path):
    (link := tmp_path / "go").symlink_to(ROOT / "run")
    for command in (link, ROOT / "run"):
        outcome = run(command, "--config", "paper", cwd="/")
        assert outcome.returncode == 1
        assert "did you mean ./run --config case=paper ?" in outcome.stderr  # it has seen cases/paper


def test_a_folder_without_permission_is_refused_with_what_to_do():
    """As another user than the owner; root may write everywhere."""
    with tempfile.TemporaryDirectory() as name:
        folder = scripts_in(Path(name))
        folder.chmod(0o755)
        user = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.getuid() == 0 else {}
        if not user:
            folder.chmod(0o555)
        outcome = run("sh", "run", cwd=folder, **user)
        folder.chmod(0o755)
    assert outcome.returncode == 1
    assert "no permission to write in" in outcome.stderr
    assert "clone bedchain into a folder of yours" in outcome.stderr


@pytest.mark.parametrize(
    ("temporary", "message"),
    [
        ("/no/such/folder", "the temporary folder /no/such/folder (TMPDIR) is missing or not yours"),
        ("/proc", "no disk space for temporary files (TMPDIR): 50 MB needed, 0 MB free in /proc"),  # is full
    ],
)
def test_a_temporary_folder_that_is_missing_or_full_is_refused(temporary, message):
    outcome = run("sh", "envs/setup.sh", cwd=ROOT, env=os.environ | {"TMPDIR": temporary})
    assert outcome.returncode == 1
    assert message in outcome.stderr


def test_settings_of_other_programs_are_left_behind(tmp_path):
    """A Python, an Open MPI and an OpenFOAM of somebody's, in the environment and on the path."""
    for program in ("mpirun", "g++", "blockMesh"):
        (tmp_path / program).write_text("#!/bin/sh\necho wrong\n")
        (tmp_path / program).chmod(0o755)
    (tmp_path / "numpy.py").write_text("raise SystemExit('wrong numpy')\n")
    others = {name: str(tmp_path) for name in FOREIGN} | {"HOME": str(tmp_path / "no home")}
    others |= {"PATH": f"{tmp_path}:{os.environ['PATH']}", "OMPI_MCA_btl": "openib", "CDPATH": "/usr"}
    command = (
        "umask 077; . envs/activate.sh; for name in mpirun g++ blockMesh; do command -v $name; done; env"
    )
    command += "; python -c 'import numpy, pyvista'"
    outcome = run("sh", "-euc", command, cwd=ROOT, env=others)
    assert outcome.returncode == 0, outcome.stderr
    programs, variables = outcome.stdout.splitlines()[:3], outcome.stdout.splitlines()[3:]
    assert programs == ["/usr/bin/mpirun", "/usr/bin/g++", "/usr/bin/blockMesh"]
    assert not {line.partition("=")[0] for line in variables} & (FOREIGN - {"WM_PROJECT_DIR"})
    assert {"WM_PROJECT_DIR=/usr/share/openfoam", "OMPI_MCA_btl=vader,self"} <= set(variables)
