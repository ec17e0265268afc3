# SPDX-License-Identifier: GPL-3.0-or-later
"""LIGGGHTS, bedFoam and OpenFOAM's tools as child processes that end with this process."""

import ctypes
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from bedchain.errors import UserError

PR_SET_PDEATHSIG = 1  # of linux/prctl.h: signal to a child when its parent dies
LINES_SHOWN = 12  # of a solver's log in an error message
ERROR_LINE = re.compile(r"ERROR|FATAL|error:|No space left|rror while loading")


def solver_environment() -> dict[str, str]:
    """Environment of the solvers; variables set by the user are kept."""
    environment = dict(os.environ)
    environment.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    environment.setdefault("OMPI_MCA_rmaps_base_oversubscribe", "1")
    # bedFoam's guards report an overflow with place and time; OpenFOAM's trap gives neither
    environment.setdefault("FOAM_SIGFPE", "false")
    # on a busy machine a waiting rank yields its core
    environment.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
    environment.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
    if os.geteuid() == 0:
        environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return environment


def on_ranks(command: list[str], ranks: int) -> list[str]:
    """The command line that runs a command on MPI ranks."""
    return command if ranks == 1 else ["mpirun", "-np", str(ranks), *command]


def run_deck(deck: Path, variables: Mapping[str, object], log: Path, ranks: int = 1) -> None:
    """Run a LIGGGHTS deck to its end.

    Parameters
    ----------
    deck : Path
        Input script.
    variables : mapping of str to object
        Variables of the deck.
    log : Path
        Gets the output, appended.
    ranks : int
        MPI ranks.

    Raises
    ------
    UserError
        As `run_logged`.
    """
    options = [word for name, value in variables.items() for word in ("-var", name, str(value))]
    run_logged(on_ranks(["liggghts", "-in", str(deck), "-log", "none", *options], ranks), log)


def _end_with_parent() -> None:
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def run_logged(
    command: list[str],
    log: Path,
    each_line: Callable[[str], None] | None = None,
    variables: Mapping[str, str] | None = None,
) -> None:
    """Run a command to its end, with its output in a log.

    Parameters
    ----------
    command : list of str
        Program and arguments.
    log : Path
        Gets stdout and stderr, appended.
    each_line : callable, optional
        Called with each line of the output.
    variables : mapping of str to str, optional
        Environment variables of the program besides those of `solver_environment`.

    Raises
    ------
    UserError
        The program is not installed, or ends with an error: its error lines, and the log.
    """
    if shutil.which(command[0]) is None:
        raise UserError(
            f"the program {command[0]} is not installed: run ./run, which installs what is missing"
        )
    with log.open("a", encoding="utf-8") as stream:
        child = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=solver_environment() | dict(variables or {}),
            preexec_fn=_end_with_parent,
        )
        try:
            assert child.stdout is not None
            for line in child.stdout:
                stream.write(line)
                if each_line:
                    each_line(line)
            code = child.wait()
        except BaseException:
            child.terminate()
            child.wait()
            raise
    if code != 0:
        raise UserError(
            f"{Path(command[0]).name} ended with code {code}:\n{error_lines(log)}\nits whole log: {log}"
        )


def error_lines(log: Path) -> str:
    """Lines of a log from its first error on, or its last lines without one."""
    lines = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    first = next(
        (at for at, line in enumerate(lines) if ERROR_LINE.search(line)), max(len(lines) - LINES_SHOWN, 0)
    )
    return "\n".join("  " + line for line in lines[first : first + LINES_SHOWN])


class Progress:
    """Progress of a run on stderr every few seconds, from bedFoam's lines of progress.

    Parameters
    ----------
    end_s : float
        Simulated time at the end of the whole run [s].
    every_s : float
        Wall time between two lines [s].
    """

    PATTERN = re.compile(r"progress time (\S+) s, (\S+) s per simulated second, \S+ s left, (.*)")
    TOTALS = re.compile(
        r"totals simulated (?P<simulated>\S+) wall (?P<wall>\S+) dem (?P<dem>\S+) "
        r"exchange (?P<exchange>\S+) gas (?P<gas>\S+)"
    )

    def __init__(self, end_s: float, every_s: float = 10.0) -> None:
        self.end_s = end_s
        self.every_s = every_s
        self.last = 0.0
        self.totals: dict[str, float] = {}

    def __call__(self, line: str) -> None:
        """Take one line of bedFoam's output."""
        totals = self.TOTALS.match(line)
        if totals:
            self.totals = {name: float(value) for name, value in totals.groupdict().items()}
        progress = self.PATTERN.match(line)
        if not progress or time.monotonic() - self.last < self.every_s:
            return
        self.last = time.monotonic()
        now_s, cost = float(progress[1]), float(progress[2])
        left = int(cost * max(self.end_s - now_s, 0))
        print(
            f"run_dem: {now_s:.3f} of {self.end_s:g} s simulated, {cost:.0f} s per simulated second, "
            f"{left // 3600}:{left // 60 % 60:02d}:{left % 60:02d} left ({progress[3].strip()})",
            file=sys.stderr,
            flush=True,
        )
