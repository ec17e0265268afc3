# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that a user can put right, reported as one message without a traceback."""

import difflib
import errno
import shlex
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
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


# what the world does to a program, and what to do about it
WORLD = {
    errno.ENOSPC: ("no space is left on its disk", "free some space"),
    errno.EDQUOT: ("your share of its disk is full", "free some space"),
    errno.EFBIG: ("it is larger than this system allows", "raise the limit (ulimit -f)"),
    errno.EACCES: ("permission is denied", "give yourself the right to it"),
    errno.EPERM: ("permission is denied", "give yourself the right to it"),
    errno.EROFS: ("its disk is read-only", "work on another disk"),
    errno.EISDIR: ("a folder stands in its place", "move that away"),
    errno.EEXIST: ("something else stands in its place", "move that away"),
    errno.ENOTDIR: ("a file stands in the place of its folder", "move that away"),
    errno.ENOENT: ("it is missing", "look whether its folder is there"),
    errno.EIO: ("the disk cannot be read or written", "look after the disk"),
    errno.EMFILE: ("too many files are open", "raise the limit (ulimit -n)"),
    errno.ENAMETOOLONG: ("its name is too long", "take a shorter path"),
    errno.ENOMEM: ("the memory is full", "end other programs"),
}


def world_error(error: OSError, file: Path | str | None = None) -> UserError | None:
    """The sentence for an error of the world: which file, what is wrong, what to do; None for any other.

    Parameters
    ----------
    error : OSError
    file : path, optional
        Where the error itself names none.
    """
    if error.errno not in WORLD:
        return None
    wrong, remedy = WORLD[error.errno]
    name = error.filename or file or "a file (its name is not known)"
    return UserError(f"{name}: {wrong}; {remedy} and give the same command again")


@contextmanager
def report_user_errors(log: Path | str | None = None) -> Iterator[None]:
    """Turn a `UserError`, or an error of the world, into its message on stderr, without a traceback.

    Parameters
    ----------
    log : path, optional
        File that gets the message too (appended).

    Raises
    ------
    SystemExit
        Code 1, after one of these; 130, after Ctrl-C. Every other exception passes unchanged.
    """
    try:
        yield
    except UserError as error:
        _report(error, log)
        raise SystemExit(1) from None
    except OSError as error:
        if (sentence := world_error(error)) is None:
            raise
        _report(sentence, log)
        raise SystemExit(1) from None
    except KeyboardInterrupt:
        print("ended on request; what is finished stays", file=sys.stderr)
        raise SystemExit(130) from None


def _report(error: UserError, log: Path | str | None) -> None:
    message = f"error: {error}"
    with suppress(OSError):  # of a full disk, or a reader that has gone
        print(message, file=sys.stderr, flush=True)
    if log is not None:
        with suppress(OSError), Path(log).open("a", encoding="utf-8") as stream:
            stream.write(message + "\n")
