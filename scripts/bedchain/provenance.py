# SPDX-License-Identifier: GPL-3.0-or-later
"""Provenance of results: versions, commit, case, machine and times."""

import csv
import hashlib
import json
import os
import platform
import shutil
import subprocess
from collections.abc import Mapping
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

from bedchain.meter import BYTES_IN_MB, physical_memory_bytes

DEBIAN_PACKAGES = (
    "liggghts", "libliggghts-dev", "openfoam", "libopenfoam", "libopenmpi-dev", "libopenblas0-serial", "g++",
)  # fmt: skip


def python_packages() -> dict[str, str]:
    """Name -> version of every installed Python package."""
    versions = {item.metadata["Name"]: item.version for item in distributions()}
    return dict(sorted(versions.items(), key=lambda pair: pair[0].lower()))


def debian_packages(names: tuple[str, ...] = DEBIAN_PACKAGES) -> dict[str, str]:
    """Name -> version of Debian packages, "not installed" where absent; empty without dpkg."""
    if shutil.which("dpkg-query") is None:
        return {}
    form = "${Package} ${Version} ${db:Status-Status}\n"
    lines = _output("dpkg-query", "--show", f"--showformat={form}", *names).splitlines()
    versions = {words[0]: words[1] for words in map(str.split, lines) if words[-1] == "installed"}
    return {name: versions.get(name, "not installed") for name in names}


def git_state() -> dict[str, Any]:
    """Commit (None outside a repository), and whether files differ from it."""
    commit = _output("git", "rev-parse", "--verify", "HEAD").strip() or None
    return {"commit": commit, "dirty": bool(_output("git", "status", "--porcelain")) if commit else None}


def machine() -> dict[str, Any]:
    """Processor, cores, memory and system, without the name of the machine or its user."""
    release = platform.freedesktop_os_release().get("PRETTY_NAME", "unknown")
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "memory_mb": int(physical_memory_bytes() / BYTES_IN_MB),
        "kernel": platform.release(),
        "system": release,
        "python": platform.python_version(),
    }


def case_hash(case: Mapping[str, Any]) -> str:
    """SHA-256 of a case with its defaults, independent of comments and order."""
    return hashlib.sha256(json.dumps(case, sort_keys=True).encode()).hexdigest()


def rule_times(folder: Path) -> dict[str, dict[str, float]]:
    """Wall time [s] and peak memory [MB] of each job that has a benchmark file.

    Parameters
    ----------
    folder : Path
        Snakemake's benchmark files, ``<job>.tsv``.

    Returns
    -------
    dict
        Job -> ``wall_s`` and, where it was measured, ``peak_rss_mb``; empty without the folder.
    """
    times = {}
    for file in sorted(folder.glob("*.tsv")):
        with file.open(encoding="utf-8", newline="") as stream:
            for row in csv.DictReader(stream, delimiter="\t"):
                times[file.stem] = {"wall_s": float(row["s"])} | _memory(row.get("max_rss", "-"))
    return times


def _memory(text: str) -> dict[str, float]:
    try:
        return {"peak_rss_mb": float(text)}
    except ValueError:  # "-" or "NA": the job was over before the first measurement
        return {}


def _processor() -> str:
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def _output(*command: str) -> str:
    if shutil.which(command[0]) is None:
        return ""
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout
