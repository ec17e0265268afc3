# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability study: each setting in its own process for a limited time, with its verdict on record."""

import re
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import asdict
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pandas as pd

from bedchain.dem.segments import input_stamp
from bedchain.errors import UserError
from bedchain.files import locked_folder
from bedchain.studies.records import remembered
from bedchain.studies.stability.settings import Known, StabilitySetting
from bedchain.studies.stability.verdict import CRASHED, FAULTS, HUNG, Verdict
from bedchain.work_folders import discard_folder, work_folder

LONGEST_S = 900.0  # of wall time for one setting; the longest takes a minute or two on an idle machine
KEPT, WORK = "kept", "work"
LAST_WORDS = 300  # letters of a traceback in a reason

Say = Callable[[str], None]


def limited(work: Callable[[], Verdict], longest_s: float) -> Verdict:
    """Verdict of `work` in a child process; hung after `longest_s`, crashed where the process ends early.

    Parameters
    ----------
    work : callable
    longest_s : float
        Wall time [s], after which the child and all solvers that it started are ended.

    Raises
    ------
    UserError
        As `work`.
    """
    context = get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_send, args=(sender, work))
    child.start()
    sender.close()
    try:
        if not receiver.poll(longest_s):
            return Verdict(HUNG, reason=f"no end after {longest_s:g} s of wall time")
        answer = receiver.recv()
    except EOFError:
        child.join()
        return Verdict(CRASHED, reason=f"its process ended with code {child.exitcode}")
    finally:
        child.terminate()
        child.join()
    if isinstance(answer, UserError):
        raise answer
    return answer


def _send(sender: Connection, work: Callable[[], Verdict]) -> None:
    """Send the verdict of `work`, or its `UserError`; any other error is a fault of ours: crashed."""
    answer: Verdict | UserError
    try:
        answer = work()
    except UserError as error:
        answer = UserError(str(error))
    except Exception:
        answer = Verdict(CRASHED, reason=" ".join(traceback.format_exc().split())[-LAST_WORDS:])
    sender.send(answer)


def record_file(folder: Path, setting: StabilitySetting, sources: list[Path]) -> Path:
    """File of a verdict, named by all that the verdict depends on."""
    stamp = input_stamp(sources, setting.inputs)
    return folder / KEPT / setting.group / f"{slug(setting)}_{stamp}.json"


def slug(setting: StabilitySetting) -> str:
    """Name of a setting's folder."""
    return re.sub(r"[^\w.]+", "_", setting.name)


def try_setting(
    setting: StabilitySetting, folder: Path, record: Path, known: Known, longest_s: float
) -> tuple[Verdict, float]:
    """Verdict and its wall time [s], from its record or by a run."""
    work = work_folder(folder / WORK) / slug(setting)

    def run() -> dict[str, Any]:
        start = time.monotonic()
        verdict = limited(lambda: setting.run(work, known), longest_s)
        return {"verdict": asdict(verdict), "wall_s": time.monotonic() - start}

    result = remembered(record, run)
    verdict = Verdict(**result["verdict"])
    if verdict.outcome not in FAULTS:  # of which the logs are wanted
        discard_folder(work)
    return verdict, result["wall_s"]


def run_study(
    settings: list[StabilitySetting],
    folder: Path,
    sources: Mapping[str, list[Path]],
    say: Say,
    longest_s: float = LONGEST_S,
) -> pd.DataFrame:
    """Table of all settings, tried one after the other.

    Parameters
    ----------
    settings : list of StabilitySetting
    folder : Path
        Holds the verdicts in ``kept/``, and the current setting in ``work/``.
    sources : mapping of str to list of Path
        Files that the verdicts of a group depend on.
    say : callable
        Called with a line for each setting, with the time left.
    longest_s : float
        Wall time of a setting [s].

    Returns
    -------
    DataFrame
        A row for each setting, in their order.

    Raises
    ------
    UserError
        Another study is running in the folder, or a program is missing.
    """
    records = {item.name: record_file(folder, item, sources[item.group]) for item in settings}
    known: dict[str, dict[str, float]] = {}
    rows, spent, runs = [], 0.0, 0
    with locked_folder(folder):
        for place, setting in enumerate(settings):
            new = not records[setting.name].exists()
            verdict, wall_s = try_setting(setting, folder, records[setting.name], known, longest_s)
            known[setting.name] = verdict.observed
            rows.append(row_of(setting, verdict, wall_s))
            spent, runs = spent + new * wall_s, runs + new
            waiting = sum(not records[item.name].exists() for item in settings[place + 1 :])
            left = int(spent / runs * waiting) if runs else 0
            outcome = f"{verdict.outcome}{f', {verdict.guard}' if verdict.guard else ''}"
            say(f"{place + 1} of {len(settings)}: {setting.name}: {outcome}, {wall_s:.1f} s; "
                f"about {left // 60}:{left % 60:02d} left")  # fmt: skip
    return pd.DataFrame(rows)


def row_of(setting: StabilitySetting, verdict: Verdict, wall_s: float) -> dict[str, object]:
    """Row of a setting in the table."""
    limit = setting.limit
    ending = {key: value for key, value in asdict(verdict).items() if key not in ("observed", "reason")}
    return {
        "group": setting.group, "setting": setting.name, "guards": setting.guards, **ending,
        "limited": limit.quantity, "limit": limit.value, "over_limit_1": limit.share,
        "formula": limit.formula, "wall_s": wall_s, "reason": verdict.reason, **setting.values,
    }  # fmt: skip
