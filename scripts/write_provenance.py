# SPDX-License-Identifier: GPL-3.0-or-later
"""What a case's results rest on: results/<case>/provenance.json."""

import hashlib
import json
from pathlib import Path

from bedchain.case.schema import Case
from bedchain.files import write_text
from bedchain.provenance import case_hash, debian_packages, git_state, machine, python_packages, rule_times
from bedchain.stage import LOG, stage


def write_provenance(case: Case, inputs: dict[str, Path], benchmarks: Path, provenance: Path) -> None:
    """Write versions, commit, case, seeds, machine, and what each job took.

    Parameters
    ----------
    case : dict
        The case with its defaults, without the looks of its figures.
    inputs : dict of str to Path
        Name -> file that the results rest on; its SHA-256 is noted.
    benchmarks : Path
        Folder of Snakemake's benchmark files.
    provenance : Path
        JSON file to make.
    """
    record = {
        "case": {"sha256": case_hash(case), "values": case},
        "seeds": {"particles": case["seed"], "chain": case["chain"]["seed"]},
        "git": git_state(),
        "packages": {"debian": debian_packages(), "python": python_packages()},
        "machine": machine(),
        "times": rule_times(benchmarks),
        "sha256": {name: hashlib.sha256(file.read_bytes()).hexdigest() for name, file in inputs.items()},
    }
    write_text(provenance, json.dumps(record, indent=2) + "\n")
    LOG.info("commit %s, %d jobs timed, in %s", record["git"]["commit"], len(record["times"]), provenance)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        write_provenance(
            dict(snakemake.params.case),
            {
                "dem": Path(snakemake.input.dem),
                "metrics": Path(snakemake.input.metrics),
                "timing": Path(snakemake.input.timing),
            },
            Path(snakemake.params.benchmarks),
            Path(snakemake.output.provenance),
        )
