# SPDX-License-Identifier: GPL-3.0-or-later
"""How a setting ended: stable, inaccurate, refused, diverged, or a fault of ours, hung or crashed."""

import math
import re
from dataclasses import dataclass, field

from bedchain.errors import CaseError
from bedchain.studies.verification.rows import Row

STABLE, INACCURATE, REFUSED, DIVERGED, HUNG, CRASHED = OUTCOMES = (
    *("stable", "inaccurate", "refused", "diverged", "hung", "crashed"),
)
FAULTS = (HUNG, CRASHED)  # neither may happen: a refused or stopped setting says why
NUMBER = r"[-+0-9.eE]+|nan|-nan|inf|-inf"
VECTOR = rf"\((?P<x>{NUMBER}) (?:{NUMBER}) (?P<z>{NUMBER})\)"
STOP = rf"at (?P<time>{NUMBER}) s\. The last finished segment is intact"
# What the solvers say where they stop a run, by the name of the guard
GUARDS = {
    "overlap": rf"particle \d+ at {VECTOR} m and (?:particle \d+|the wall \w+) overlap by .*?{STOP}",
    "lost particle": rf"particle \d+ has left the bed \(\d+ lost\), last seen at {VECTOR} m, {STOP}",
    "voidage": rf"voidage \S+ in the gas cell at {VECTOR} m, .*?{STOP}",
    "pressure": rf"the pressure is not solved .*? in the gas cell at {VECTOR} m, {STOP}",
    "divergence": rf"the run has diverged .*? in the gas cell at {VECTOR} m, {STOP}",
    "gas solver": rf"fastest gas .*? in the gas cell at {VECTOR} m, {STOP}",
    # LIGGGHTS tells neither place nor time, and numbers that are wrong
    "lost particle while settling": r"Lost atoms",
}


@dataclass(frozen=True)
class Verdict:
    """How one setting ended.

    Attributes
    ----------
    outcome : str
        One of `OUTCOMES`.
    guard : str
        What refused or stopped it.
    reason : str
        In one sentence.
    time_s, x_m, z_m : float
        Where and when it was stopped [s], [m].
    quantity : str
        What is worst, of all that was looked at.
    value, reference, tolerance : float
        That quantity, what it should be, and how near is near enough (`verification.rows.Row`).
    observed : dict of str to float
        What other settings are compared with.
    """

    outcome: str
    guard: str = ""
    reason: str = ""
    time_s: float = math.nan
    x_m: float = math.nan
    z_m: float = math.nan
    quantity: str = ""
    value: float = math.nan
    reference: float = math.nan
    tolerance: float = math.nan
    observed: dict[str, float] = field(default_factory=dict)


def excess(row: Row) -> float:
    """Distance from the reference over the tolerance [1]; above 1 does not pass, a NaN is infinitely off."""
    scale = row.tolerance * (abs(row.reference) or 1.0)
    off = abs(row.value - row.reference) / scale
    return off if math.isfinite(off) else math.inf


def judge(rows: list[Row], observed: dict[str, float] | None = None) -> Verdict:
    """Stable where every quantity is near enough, else inaccurate; the worst one is told.

    Parameters
    ----------
    rows : list of Row
        At least one.
    observed : dict of str to float, optional
    """
    worst = max(rows, key=excess)
    if worst.passed:
        outcome, reason = STABLE, ""
    else:
        outcome = INACCURATE
        reason = f"{worst.quantity} {worst.value:.4g}, {worst.reference:.4g} expected ({worst.source})"
    return Verdict(
        outcome, reason=reason, quantity=worst.quantity, value=worst.value, reference=worst.reference,
        tolerance=worst.tolerance, observed=observed or {},
    )  # fmt: skip


def refused(error: CaseError) -> Verdict:
    """A case that its checks refuse: which key, the limit and the remedy."""
    first = error.problems[0]
    return Verdict(
        REFUSED, f"check of {first.key}", "; ".join(f"{item.key}: {item.wrong}" for item in error.problems)
    )


def stopped(text: str) -> Verdict:
    """A run that its solvers stopped: the guard, the place and the time, by their own words.

    Parameters
    ----------
    text : str
        What the command line said.

    Returns
    -------
    Verdict
        Diverged; crashed where no guard said why, or with a traceback.
    """
    text = " ".join(text.split())
    for guard, pattern in GUARDS.items():
        found = re.search(pattern, text)
        if found and "Traceback" not in text:
            numbers = {name: float(value) for name, value in found.groupdict().items()}
            when, x, z = (numbers.get(name, math.nan) for name in ("time", "x", "z"))
            reason = found[0].removesuffix(" The last finished segment is intact")
            return Verdict(DIVERGED, guard, reason, when, x, z)
    return Verdict(CRASHED, reason=text[-500:])
