# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that a user can put right, reported as one message without a traceback."""

import difflib
import shlex
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path


class UserError(Exception):
    """An error that the user can put right; the message names the datum and the remedy."""


class DataError(UserError, ValueError):
    """Data that cannot be used; the message names them, the place, and the remedy."""


@dataclass(frozen=True)
class Problem:
    """A problem of a case file.

    Attributes
    ----------
    key : str
        Dotted path of the key, such as ``bed.width_m``.
    wrong : str
        The fault, with the value.
    remedy : str
        The correction.
    line : int or None
        Line in the file, from 1; None where the key is not in the file (missing, or a default).
    """

    key: str
    wrong: str
    remedy: str
    line: int | None = None

    def __str__(self) -> str:
        place = f"line {self.line}, " if self.line else ""
        return f"{place}{self.key}: {self.wrong}; {self.remedy}"


class CaseError(UserError):
    """A case file that cannot be run; its message lists every problem.

    Parameters
    ----------
    file : Path or str
        The case file.
    problems : list of Problem
        At least one.
    """

    def __init__(self, file: Path | str, problems: list[Problem]) -> None:
        self.file = Path(file)
        self.problems = problems
        count = "1 problem" if len(problems) == 1 else f"{len(problems)} problems"
        super().__init__("\n".join([f"{file} has {count}:", *(f"  {problem}" for problem in problems)]))


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that was probably meant; None where none is near."""
    near = difflib.get_close_matches(word.lower(), known, 1)
    return near[0] if near else None


def guess(word: str, known: Iterable[str]) -> str:
    """The known word that was probably meant, as an end of a message; empty where none is near."""
    near = nearest(word, known)
    return f"; did you mean {near}?" if near else ""


def make_again(*files: Path | str) -> str:
    """Remedy of a message: the line that makes files of a run again, without anything deleted."""
    return f"make it again: {shlex.join(['./run', '--force', *map(str, files)])}"


@contextmanager
def report_user_errors(log: Path | str | None = None) -> Iterator[None]:
    """Turn a `UserError` into its message on stderr and exit code 1, without a traceback.

    Parameters
    ----------
    log : path, optional
        File that gets the message too (appended).

    Raises
    ------
    SystemExit
        Code 1, after a `UserError`; every other exception passes unchanged.
    """
    try:
        yield
    except UserError as error:
        message = f"error: {error}"
        print(message, file=sys.stderr)
        if log is not None:
            with Path(log).open("a", encoding="utf-8") as stream:
                stream.write(message + "\n")
        raise SystemExit(1) from None
