# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks before a job is queued: a cluster that answers, and a time limit in which a job gets on."""

import math
import shutil
import subprocess

from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.studies.cost.job_limits import shortest_useful_minutes

PROGRAMS = ("sbatch", "squeue", "scancel")
PATIENCE_S = 60  # for SLURM's answer


def check_slurm() -> None:
    """Refuse to submit jobs where nobody takes them.

    Raises
    ------
    UserError
        SLURM's programs are not installed, or its controller does not answer.
    """
    way = "start ./run on a machine that submits jobs, or without --profile"
    if missing := [program for program in PROGRAMS if shutil.which(program) is None]:
        raise UserError(f"there is no SLURM on this machine: no {', '.join(missing)}; {way}")
    try:
        asked = subprocess.run(
            ["sinfo", "--noheader"], capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )
    except subprocess.TimeoutExpired:
        raise UserError(f"SLURM does not answer (sinfo, {PATIENCE_S} s): try again later; or {way}") from None
    if asked.returncode:
        reason = (asked.stderr.strip().splitlines() or ["it gives no reason"])[-1]
        raise UserError(f"SLURM does not answer ({reason}): try again later; or {way}")


def check_time_limit(case: Case, rule: str, limit_min: int) -> None:
    """Refuse a time limit that ends a job before it has made anything to go on from.

    Parameters
    ----------
    case : dict
        A checked case of a bed.
    rule : {"run_dem", "repeat_dem"}
    limit_min : int
        Its ``runtime`` [min].

    Raises
    ------
    UserError
        Names the limit, the estimate and a way out.
    """
    needed_min = shortest_useful_minutes(case, rule)
    if limit_min < needed_min:
        raise UserError(
            f"a job of {rule} gets {limit_min} min (runtime), too short for a segment, about "
            f"{needed_min:.1f} min: each try would begin anew; take a shorter time.segment_s or settle_s, "
            f"or --set-resources {rule}:runtime={math.ceil(2 * needed_min)}"
        )
