# SPDX-License-Identifier: GPL-3.0-or-later
"""The set-up's own decisions and error messages; nothing is installed."""

import hashlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from made import ROOT

ENVS = ROOT / "envs"
LISTS = ("requirements", "requirements-checks")  # what ./run needs, and what ./test needs besides
NOBODY = 65534  # a user that exists on every Debian and owns nothing
NO_PACKAGE = "bedchain-no-such-package"

DEB822 = """\
# Types: deb-src
Types: deb
# a comment inside
URIs: http://mirror.example/debian
Suites: bookworm bookworm-updates
Components: main contrib
Architectures: amd64
Signed-By: /usr/share/keyrings/archive.gpg

Enabled: no
Types: deb
URIs: http://off.example/debian
Suites: bookworm
Components: main

Types: deb
URIs: http://other.example/node
Suites: nodistro
Components: main

Types: deb deb-src
URIs: http://security.example/debian-security
Suites: bookworm-security
Components: main
"""
DEB822_SOURCES = """\
Types: deb-src
URIs: http://mirror.example/debian
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/archive.gpg

Types: deb-src
URIs: http://security.example/debian-security
Suites: bookworm-security
Components: main

"""
ONE_LINE = """\
deb http://mirror.example/debian bookworm main contrib non-free
# deb http://off.example/debian bookworm main
deb-src http://mirror.example/debian bookworm main
deb [arch=amd64 signed-by=/k.gpg] http://security.example/debian-security bookworm-security contrib main # why
deb http://mirror.example/debian bookworm contrib
deb http://mirror.example/debian trixie main
deb http://other.example/cloud cloud-bookworm main
"""
ONE_LINE_SOURCES = """\
deb-src http://mirror.example/debian bookworm main
deb-src [arch=amd64 signed-by=/k.gpg] http://security.example/debian-security bookworm-security main
"""


def run_shell(*command: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)


def functions_of_common(command: str) -> subprocess.CompletedProcess[str]:
    return run_shell("sh", "-euc", f". envs/common.sh; {command}", cwd=ROOT)


@pytest.fixture
def open_envs() -> Iterator[Path]:
    """The set-up's scripts in a folder that any user can read."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)
        for script in ENVS.glob("*.sh"):
            shutil.copy(script, folder)
        yield folder


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("sources.list.d/debian.sources", DEB822, {"sources": DEB822_SOURCES, "list": ""}),
        ("sources.list", ONE_LINE, {"sources": "", "list": ONE_LINE_SOURCES}),
        ("sources.list.d/debian.list", ONE_LINE, {"sources": "", "list": ONE_LINE_SOURCES}),
    ],
)
def test_source_entries_come_from_the_machines_own(
    tmp_path: Path, name: str, content: str, expected: dict[str, str]
) -> None:
    (tmp_path / "sources.list.d").mkdir()
    (tmp_path / name).write_text(content)
    run_shell("sh", ENVS / "source_list.sh", tmp_path, "bookworm", tmp_path / "derived", check=True)
    assert {end: (tmp_path / f"derived/derived.{end}").read_text() for end in expected} == expected


def test_sources_without_the_release_are_an_error(tmp_path: Path) -> None:
    (tmp_path / "sources.list").write_text("deb http://mirror.example/debian trixie main\n")
    outcome = run_shell("sh", ENVS / "source_list.sh", tmp_path, "bookworm", tmp_path / "derived")
    assert outcome.returncode == 1
    assert "names no source of bookworm with component main" in outcome.stderr


@pytest.mark.parametrize("name", LISTS)
def test_each_pin_has_hashes_and_no_address(name: str) -> None:
    lock = (ENVS / f"{name}.txt").read_text()
    entries = re.split(r"\n(?=\S)", lock.strip())
    assert len(entries) > 30
    for entry in entries:
        assert re.match(r"[a-z0-9-]+==\S+ \\\n    --hash=sha256:[0-9a-f]{64}", entry), entry
    assert "//" not in lock


def wanted_packages(name: str = "requirements") -> list[str]:
    lines = (ENVS / f"{name}.in").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def pins(name: str) -> dict[str, str]:
    """Package -> version in a lock."""
    return dict(re.findall(r"^([a-z0-9-]+)==(\S+)", (ENVS / f"{name}.txt").read_text(), re.MULTILINE))


@pytest.mark.parametrize("name", LISTS)
def test_each_wanted_package_is_pinned(name: str) -> None:
    assert set(wanted_packages(name)) <= set(pins(name))


def test_both_locks_agree_and_no_package_is_wanted_twice() -> None:
    run, checks = (pins(name) for name in LISTS)
    assert {package: run[package] for package in run.keys() & checks.keys()}.items() <= checks.items()
    assert not set(wanted_packages(LISTS[0])) & set(wanted_packages(LISTS[1]))


def test_what_runs_imports_nothing_of_the_checks_packages() -> None:
    checked = "|".join(package.replace("-", "_") for package in wanted_packages(LISTS[1]))
    imports = re.compile(rf"^\s*(?:from|import) ({checked})\b", re.MULTILINE)
    files = [file for file in (ROOT / "scripts").rglob("*.py") if imports.search(file.read_text())]
    assert [file.name for file in files] == ["benchmark_core.py"]  # by hand, says so where it is missing


def test_an_unknown_word_is_refused_before_anything_is_installed() -> None:
    outcome = run_shell("sh", "envs/setup.sh", "cheks", cwd=ROOT)
    assert outcome.returncode == 1
    assert "knows the word 'checks' only, not 'cheks'" in outcome.stderr


def test_help_names_each_target_key_and_case() -> None:
    words = set(re.findall(r"[\w-]+", run_shell("sh", "run", "--help", cwd=ROOT, check=True).stdout))
    workflow = {file: file.read_text() for file in (ROOT / "Snakefile", *(ROOT / "scripts").glob("*.smk"))}
    rules = re.findall(
        r"^rule (\w+):\n((?:    .*\n|\n)+)", workflow[ROOT / "scripts/studies.smk"], re.MULTILINE
    )
    targets = {name for name, body in rules if "output:" not in body}
    keys = set(re.findall(r"WORDS\.get\(\"(\w+)\"", "".join(workflow.values())))
    assert len(targets) > 5
    assert targets <= words
    assert keys - {"studies"} <= words  # of the paper's module
    assert {file.parent.name for file in (ROOT / "cases").glob("*/case.yaml")} <= words


def test_conda_has_the_versions_of_the_lock() -> None:
    conda_names = {"snakemake-minimal": "snakemake", "matplotlib-base": "matplotlib"}
    lines = yaml.safe_load((ENVS / "python.yaml").read_text())["dependencies"]
    conda = {conda_names.get(name, name): version for name, version in (line.split("=") for line in lines)}
    lock = dict(
        re.findall(r"^([a-z0-9-]+)==(\d+\.\d+)", (ENVS / "requirements.txt").read_text(), re.MULTILINE)
    )
    assert conda.pop("python") == "3.11"
    assert conda == {name: lock[name] for name in wanted_packages() if name not in ("uv", "setuptools")}


def test_missing_package_without_root_names_the_line_to_run(open_envs: Path) -> None:
    user = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.getuid() == 0 else {}
    # no_new_privs keeps sudo from working, so that this holds for a user who may use it, too.
    outcome = run_shell(
        "setpriv", "--no-new-privs", "sh", open_envs / "debian_packages.sh", "/dev/null", "dpkg", NO_PACKAGE,
        cwd="/", **user,
    )  # fmt: skip
    assert outcome.returncode == 1
    line = f"sudo apt-get update && sudo apt-get install -y --no-install-recommends {NO_PACKAGE}\n"
    assert line in outcome.stderr


def test_packages_that_are_there_need_no_root(open_envs: Path) -> None:
    outcome = run_shell("sh", open_envs / "debian_packages.sh", "/dev/null", "dpkg", "apt")
    assert (outcome.returncode, outcome.stdout, outcome.stderr) == (0, "", "")


def test_machine_without_apt_is_told_what_to_install(open_envs: Path, tmp_path: Path) -> None:
    (tmp_path / "dirname").symlink_to(shutil.which("dirname") or "")
    outcome = run_shell(
        "/bin/sh", open_envs / "debian_packages.sh", "/dev/null", "g++", "make", env={"PATH": str(tmp_path)}
    )
    assert outcome.returncode == 1
    assert "no dpkg-query here" in outcome.stderr
    assert "g++ make" in outcome.stderr


def test_lack_of_space_names_needed_and_free_room() -> None:
    outcome = functions_of_common("need_space . 999999999 'Python packages'")
    assert outcome.returncode == 1
    assert re.search(
        r"no disk space for Python packages: 999999999 MB needed, \d+ MB free in /", outcome.stderr
    )
    assert functions_of_common("need_space . 0 nothing").returncode == 0


def test_failed_command_shows_its_last_words(tmp_path: Path) -> None:
    outcome = functions_of_common(
        f"logged '{tmp_path}/log' 'a trial' sh -c 'echo last words; exit 3'; echo on"
    )
    assert outcome.returncode == 1
    assert outcome.stdout == ""
    assert "last words\nsetup: error: a trial failed" in outcome.stderr


def test_step_is_done_once_for_each_state_of_its_inputs(tmp_path: Path) -> None:
    made = tmp_path / "made"

    def step(key: str, command: str) -> subprocess.CompletedProcess[str]:
        return functions_of_common(f"step '{made}' {key} 'making it' {command}")

    assert step("one", f"mkdir '{made}'").returncode == 0
    assert step("one", "false").stderr == ""
    assert step("two", "false").returncode == 1
    assert step("two", "true").stderr.startswith("setup: making it\n")


def test_interrupted_step_does_not_look_finished(tmp_path: Path) -> None:
    killed = "sh -c 'kill -9 $PPID'"
    assert functions_of_common(f"step '{tmp_path}' one 'making it' {killed}").returncode == -signal.SIGKILL
    assert "making it" in functions_of_common(f"step '{tmp_path}' one 'making it' true").stderr


@pytest.mark.parametrize("mark", [".stamp", ".unfinished"])
def test_what_the_set_up_made_before_is_made_anew(tmp_path: Path, mark: str) -> None:
    (tmp_path / ".venv" / "lib").mkdir(parents=True)
    (tmp_path / ".venv" / mark).touch()
    assert functions_of_common(f"clear_ours '{tmp_path}/.venv'; clear_ours '{tmp_path}/new'").returncode == 0
    for folder in (".venv", "new"):
        assert [file.name for file in (tmp_path / folder).iterdir()] == [".unfinished"]


def test_a_users_own_environment_stays_as_it_is(tmp_path: Path) -> None:
    """Some editors make a .venv in the folder of a project."""
    (tmp_path / ".venv" / "lib").mkdir(parents=True)
    (tmp_path / ".venv" / "lib" / "thesis.py").touch()
    outcome = functions_of_common(f"clear_ours '{tmp_path}/.venv'")
    assert outcome.returncode == 1
    assert (
        ".venv, which was not made by bedchain (no .stamp in it): it stays as it is; move it"
        in outcome.stderr
    )
    assert (tmp_path / ".venv" / "lib" / "thesis.py").exists()


def test_of_a_link_only_the_link_goes(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / ".stamp").touch()
    (tmp_path / ".venv").symlink_to(tmp_path / "shared")
    assert functions_of_common(f"clear_ours '{tmp_path}/.venv'").returncode == 0
    assert not (tmp_path / ".venv").is_symlink() and (tmp_path / "shared" / ".stamp").exists()


@pytest.mark.parametrize("content", [b"as described", b"broken"])
def test_source_package_is_checked_by_its_own_checksums(tmp_path: Path, content: bytes) -> None:
    digest = hashlib.sha256(b"as described").hexdigest()
    (tmp_path / "x_1.dsc").write_text(
        f"Checksums-Sha1:\n 00 12 x.tar\nChecksums-Sha256:\n {digest} 12 x.tar\nFiles:\n 00 12 x.tar\n"
    )
    (tmp_path / "x.tar").write_bytes(content)
    outcome = functions_of_common(f"check_source_package '{tmp_path}'")
    assert outcome.returncode == (content == b"broken")
    assert ("does not match its own checksums" in outcome.stderr) == (content == b"broken")
