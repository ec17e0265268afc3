# SPDX-License-Identifier: GPL-3.0-or-later
"""Provenance of a case's results: results/<case>/provenance.json."""

import hashlib
import json
from pathlib import Path

from bedchain.case.schema import Case
from bedchain.files import write_text
from bedchain.provenance import case_hash, debian_packages, git_state, machine, python_packages, rule_times
from bedchain.stage import LOG, run_stage


def write_provenance(
    case: Case,
    metrics: Path | list[Path],
    benchmarks: Path,
    provenance: Path,
    dem: Path | None = None,
    timing: Path | None = None,
) -> None:
    """Write versions, commit, case, seeds, machine, and what each job took.

    Parameters
    ----------
    case : dict
        The case with its defaults, without the looks of its figures.
    metrics, dem, timing : Path
        Files that the results rest on; their SHA-256 are noted. Of imported frames ``trajectory.json``
        stands in place of dem.json; of tracers there are no metrics, of a network nothing else.
    benchmarks : Path
        Folder of Snakemake's benchmark files.
    provenance : Path
        JSON file to make.
    """
    inputs = {"dem": dem, "metrics": metrics, "timing": timing}
    drawn = case["chain" if "chain" in case else "network"]
    record = {
        "case": {"sha256": case_hash(case), "values": case},
        "seeds": {"particles": case.get("seed"), "chain": drawn["seed"]},
        "git": git_state(),
        "packages": {"debian": debian_packages(), "python": python_packages()},
        "machine": machine(),
        "times": rule_times(benchmarks),
        "sha256": {
            name: hashlib.sha256(file.read_bytes()).hexdigest()
            for name, file in inputs.items()
            if isinstance(file, Path)
        },
    }
    write_text(provenance, json.dumps(record, indent=2) + "\n")
    LOG.info("commit %s, %d jobs timed, in %s", record["git"]["commit"], len(record["times"]), provenance)


if rule := globals().get("snakemake"):
    run_stage(write_provenance, rule)
