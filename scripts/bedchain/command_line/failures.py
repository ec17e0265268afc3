# SPDX-License-Identifier: GPL-3.0-or-later
"""The last lines after a failure: the stage, its case, the sentence of the error, its log, the way on."""

import re
import time
from collections.abc import Iterable
from pathlib import Path

STARTED_S = time.time()  # of this process, about
FAILED = re.compile(r"Error in rule (\w+):\n(?:    .*\n)*?    log: ([^ ,]+)", re.MULTILINE)
STOPPED = "Terminating processes on user request"
LINES = 12  # of an error, at most
LAST_LINES = 3  # of a log without a sentence
UNREADABLE = re.compile(r"\x1b\[[0-9;]*[A-Za-z]|[\x00-\x08\x0b\x0c\x0e-\x1f]")


def failure_report(logs: Iterable[Path], since_s: float = STARTED_S) -> str:
    """The last lines of a run that failed or was stopped.

    Parameters
    ----------
    logs : iterable of Path
        Snakemake's own, of the run.
    since_s : float
        Start of the run; an older log of a rule is not of it [s since 1970].

    Returns
    -------
    str
        Empty where no job failed: snakemake's own last words are the cause then.
    """
    text = "\n".join(_text(log) or "" for log in logs)
    stopped = STOPPED in text
    lines: list[str] = []
    for rule, rule_log in dict.fromkeys(FAILED.findall(text)):
        lines.append(f"{'Stopped' if stopped else 'Failed'}: {_stage(rule, Path(rule_log))}")
        lines += [] if stopped else [f"  {line}" for line in _explained(Path(rule_log), since_s)]
    if not lines:
        return ""
    way = "give" if stopped else "mend the cause, then give"
    return "\n".join(["", *lines, f"To go on: {way} the same command again; what is finished stays."])


def cause(text: str) -> list[str]:
    """The error that a log ends with: its sentence, or its last lines where it has none.

    Parameters
    ----------
    text : str
        Of the log.

    Returns
    -------
    list of str
        At least one line.
    """
    lines = [line.rstrip() for line in UNREADABLE.sub("", text.replace("\r", "\n")).splitlines()]
    lines = [line for line in lines if line]
    starts = [place for place, line in enumerate(lines) if line.startswith("error: ")]
    if starts:
        sentence = lines[starts[-1] :]
        return sentence[:LINES] + ["(more in the log)"] * (len(sentence) > LINES)
    if "Traceback (most recent call last):" in lines:
        return lines[-1:]
    return lines[-LAST_LINES:] or ["(its log is empty; what it said is above)"]


def _stage(rule: str, log: Path) -> str:
    """A rule and its case, by the folder of its log: logs/<case>/<rule>.log."""
    if len(log.parts) < 3:
        return rule
    case = log.parts[1]
    return f"{rule.removeprefix(f'{case}_')} of {case}"


def _explained(log: Path, since_s: float) -> list[str]:
    text = _text(log)
    if text is None or log.stat().st_mtime < since_s:
        return ["(it wrote no log; what it said is above)"]
    return [*cause(text), f"Its log: {log}"]


def _text(file: Path) -> str | None:
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
