# SPDX-License-Identifier: GPL-3.0-or-later
"""Try every setting in a process of its own, for a limited time, and keep each verdict."""

import re
import shutil
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
from bedchain.studies.stability.settings import Known, Setting
from bedchain.studies.stability.verdict import CRASHED, FAULTS, HUNG, Verdict

LONGEST_S = 900.0  # of wall time for one setting; the longest takes a minute or two on an idle machine
KEPT, WORK = "kept", "work"
LAST_WORDS = 300  # letters of a traceback in a reason

Say = Callable[[str], None]


def limited(work: Callable[[], Verdict], longest_s: float) -> Verdict:
    """The verdict of `work`, done in a child process; hung after so long, crashed where it breaks.

    Parameters
    ----------
    work : callable
    longest_s : float
        Wall time [s]; after it the child and all solvers that it started are ended.

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
        found = receiver.recv()
    except EOFError:
        child.join()
        return Verdict(CRASHED, reason=f"its process ended with code {child.exitcode}")
    finally:
        child.terminate()
        child.join()
    if isinstance(found, UserError):
        raise found
    return found


def _send(sender: Connection, work: Callable[[], Verdict]) -> None:
    """Send what `work` gives; an error that is no `UserError` is a fault of ours, and a verdict."""
    found: Verdict | UserError
    try:
        found = work()
    except UserError as error:
        found = UserError(str(error))
    except Exception:
        found = Verdict(CRASHED, reason=" ".join(traceback.format_exc().split())[-LAST_WORDS:])
    sender.send(found)


def record_file(folder: Path, setting: Setting, sources: list[Path]) -> Path:
    """Where a verdict is kept; its name changes with everything that the verdict depends on."""
    stamp = input_stamp(sources, 1, setting.inputs)
    return folder / KEPT / setting.group / f"{slug(setting)}_{stamp}.json"


def slug(setting: Setting) -> str:
    """Name of a setting's folder."""
    return re.sub(r"[^\w.]+", "_", setting.name)


def tried(
    setting: Setting, folder: Path, record: Path, known: Known, longest_s: float
) -> tuple[Verdict, float]:
    """A verdict and its wall time [s], from its record, or made and recorded."""
    work = folder / WORK / slug(setting)

    def made() -> dict[str, Any]:
        start = time.monotonic()
        verdict = limited(lambda: setting.run(work, known), longest_s)
        return {"verdict": asdict(verdict), "wall_s": time.monotonic() - start}

    found = remembered(record, made)
    verdict = Verdict(**found["verdict"])
    if verdict.outcome not in FAULTS:  # whose logs somebody will want to read
        shutil.rmtree(work, ignore_errors=True)
    return verdict, found["wall_s"]


def run_study(
    settings: list[Setting],
    folder: Path,
    sources: Mapping[str, list[Path]],
    say: Say,
    longest_s: float = LONGEST_S,
) -> pd.DataFrame:
    """Try all settings, one after the other.

    Parameters
    ----------
    settings : list of Setting
    folder : Path
        Keeps ``kept/``, and ``work/`` of what is being tried.
    sources : mapping of str to list of Path
        Files that the verdicts of a group depend on.
    say : callable
        Gets a line for each setting, with the time left.
    longest_s : float
        Wall time of a setting [s].

    Returns
    -------
    DataFrame
        One row a setting, in their order.

    Raises
    ------
    UserError
        Another study is at work in the folder, or a program is missing.
    """
    records = {item.name: record_file(folder, item, sources[item.group]) for item in settings}
    known: dict[str, dict[str, float]] = {}
    rows, spent, made = [], 0.0, 0
    with locked_folder(folder):
        for place, setting in enumerate(settings):
            new = not records[setting.name].exists()
            verdict, wall_s = tried(setting, folder, records[setting.name], known, longest_s)
            known[setting.name] = verdict.observed
            rows.append(row_of(setting, verdict, wall_s))
            spent, made = spent + new * wall_s, made + new
            waiting = sum(not records[item.name].exists() for item in settings[place + 1 :])
            left = int(spent / made * waiting) if made else 0
            told = f"{verdict.outcome}{f', {verdict.guard}' if verdict.guard else ''}"
            say(f"{place + 1} of {len(settings)}: {setting.name}: {told}, {wall_s:.1f} s; "
                f"about {left // 60}:{left % 60:02d} left")  # fmt: skip
    return pd.DataFrame(rows)


def row_of(setting: Setting, verdict: Verdict, wall_s: float) -> dict[str, object]:
    """One row of the table."""
    limit = setting.limit
    told = {key: value for key, value in asdict(verdict).items() if key not in ("observed", "reason")}
    return {
        "group": setting.group, "setting": setting.name, "guards": setting.guards, **told,
        "limited": limit.quantity, "limit": limit.value, "over_limit_1": limit.share,
        "formula": limit.formula, "wall_s": wall_s, "reason": verdict.reason, **setting.values,
    }  # fmt: skip
