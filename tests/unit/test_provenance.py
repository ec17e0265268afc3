# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results come from: versions, commit, case, machine, times."""

import json
import os
import platform
import shutil
import socket
import subprocess
from importlib.metadata import version

import pytest

from bedchain.provenance import case_hash, debian_packages, git_state, machine, python_packages, rule_times


def test_versions_are_those_of_this_environment():
    packages = python_packages()
    assert packages["numpy"] == version("numpy")
    assert packages["snakemake"] == version("snakemake")


def test_debian_packages_are_told_apart_from_missing_ones():
    found = debian_packages(("dpkg", "no-such-package-at-all"))
    if shutil.which("dpkg-query") is None:
        assert found == {}
    else:
        assert found["no-such-package-at-all"] == "not installed"
        assert found["dpkg"][0].isdigit()


def test_machine_is_described_without_its_name():
    described = machine()
    assert described["cores"] == os.cpu_count()
    assert described["memory_mb"] > 100
    assert described["python"] == platform.python_version()
    names = {socket.gethostname(), platform.node()} - set(described["processor"].split()) - {""}
    assert not any(name == value for name in names for value in map(str, described.values()))


def test_commit_and_changes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert git_state() == {"commit": None, "dirty": None}
    who = ["-c", "user.name=a", "-c", "user.email=a@b.c"]
    (tmp_path / "file").write_text("one", encoding="utf-8")
    for command in (["init", "-q"], ["add", "file"], [*who, "commit", "-q", "-m", "first"]):
        subprocess.run(["git", *command], check=True)
    clean = git_state()
    assert len(clean["commit"]) == 40 and clean["dirty"] is False
    (tmp_path / "file").write_text("two", encoding="utf-8")
    assert git_state() == {"commit": clean["commit"], "dirty": True}


def test_case_hash_depends_on_values_only():
    case = {"bed": {"width_m": 0.1, "height_m": 0.5}, "seed": 10007}
    same = {"seed": 10007, "bed": {"height_m": 0.5, "width_m": 0.1}}
    other = {"seed": 10007, "bed": {"height_m": 0.5, "width_m": 0.2}}
    assert case_hash(case) == case_hash(same) != case_hash(other)
    assert case_hash(json.loads(json.dumps(case))) == case_hash(case)


def test_times_are_read_from_benchmarks(tmp_path):
    header = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"
    (tmp_path / "run_dem.tsv").write_text(header + "12.5\t0:00:12\t80.25\t1\t1\t1\t0\t0\t99\t12\n")
    (tmp_path / "quick.tsv").write_text(header + "0.1\t0:00:00\t-\t-\t-\t-\t-\t-\t-\t-\n")
    times = rule_times(tmp_path)
    assert times == {
        "quick": {"wall_s": 0.1},
        "run_dem": {"wall_s": 12.5, "peak_rss_mb": pytest.approx(80.25)},
    }
    assert rule_times(tmp_path / "none") == {}
