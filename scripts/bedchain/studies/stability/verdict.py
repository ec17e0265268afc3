# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdict of a setting: stable, inaccurate, refused, diverged, or by a fault of ours hung or crashed."""

import math
import re
from dataclasses import dataclass, field

from bedchain.errors import CaseError
from bedchain.studies.verification.rows import Row

STABLE, INACCURATE, REFUSED, DIVERGED, HUNG, CRASHED = OUTCOMES = (
    *("stable", "inaccurate", "refused", "diverged", "hung", "crashed"),
)
FAULTS = (HUNG, CRASHED)  # these may not happen: a guard should refuse or stop the setting with a reason
NUMBER = r"[-+0-9.eE]+|nan|-nan|inf|-inf"
VECTOR = rf"\((?P<x>{NUMBER}) (?:{NUMBER}) (?P<z>{NUMBER})\)"
STOP = rf"at (?P<time>{NUMBER}) s\. The last finished segment is intact"
# Messages of the solvers that stop a run, by the name of the guard
GUARDS = {
    "overlap": rf"particle \d+ at {VECTOR} m and (?:particle \d+|the wall \w+) overlap by .*?{STOP}",
    "lost particle": rf"particle \d+ has left the bed \(\d+ lost\), last seen at {VECTOR} m, {STOP}",
    "voidage": rf"voidage \S+ in the gas cell at {VECTOR} m, .*?{STOP}",
    "pressure": rf"the pressure is not solved .*? in the gas cell at {VECTOR} m, {STOP}",
    "divergence": rf"the run has diverged .*? in the gas cell at {VECTOR} m, {STOP}",
    "gas solver": rf"fastest gas .*? in the gas cell at {VECTOR} m, {STOP}",
    # LIGGGHTS gives neither place nor time, and wrong numbers
    "lost particle while settling": r"Lost atoms",
}


@dataclass(frozen=True)
class Verdict:
    """Outcome of a setting and its reason.

    Attributes
    ----------
    outcome : str
        Of `OUTCOMES`.
    guard : str
        Guard that refused or stopped it.
    reason : str
        In one sentence.
    time_s, x_m, z_m : float
        Time and place of the stop [s], [m].
    quantity : str
        Quantity with the largest excess over its tolerance.
    value, reference, tolerance : float
        Of that quantity (`verification.rows.Row`).
    observed : dict of str to float
        Values with which other settings are compared.
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
    """Distance from the reference over the tolerance [1]; above 1 it fails, infinite for a NaN."""
    scale = row.tolerance * (abs(row.reference) or 1.0)
    off = abs(row.value - row.reference) / scale
    return off if math.isfinite(off) else math.inf


def judge(rows: list[Row], observed: dict[str, float] | None = None) -> Verdict:
    """Verdict of a finished run: stable where all rows pass, else inaccurate; with the worst row.

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
    """Verdict of a case that its checks refuse, with key, limit and remedy."""
    first = error.problems[0]
    return Verdict(
        REFUSED, f"check of {first.key}", "; ".join(f"{item.key}: {item.wrong}" for item in error.problems)
    )


def stopped(text: str) -> Verdict:
    """Verdict of a run that its solvers stopped, with guard, place and time from their messages.

    Parameters
    ----------
    text : str
        Output of the run.

    Returns
    -------
    Verdict
        Diverged; crashed without the message of a guard, or with a traceback.
    """
    text = " ".join(text.split())
    for guard, pattern in GUARDS.items():
        match = re.search(pattern, text)
        if match and "Traceback" not in text:
            numbers = {name: float(value) for name, value in match.groupdict().items()}
            when, x, z = (numbers.get(name, math.nan) for name in ("time", "x", "z"))
            reason = match[0].removesuffix(" The last finished segment is intact")
            return Verdict(DIVERGED, guard, reason, when, x, z)
    return Verdict(CRASHED, reason=text[-500:])
