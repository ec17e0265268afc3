# SPDX-License-Identifier: GPL-3.0-or-later
"""LIGGGHTS, bedFoam and OpenFOAM's tools as child processes that end with this process."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from bedchain.errors import UserError
from bedchain.lifetime import child_ends_with_parent, descendants

# mpirun's ranks are its children, not ours: each gets SIGKILL as soon as mpirun has ended, however it ended
RANK_ENDS_WITH_MPIRUN = ("setpriv", "--pdeathsig", "KILL")
LAUNCHER = "BEDCHAIN_LAUNCHER"  # environment variable: starts ranks on several nodes, such as srun --mpi=pmix
# A solver that writes no line for so long makes no progress. Its start and its longest step without a line
# take seconds; ten minutes leave room for a machine that swaps or a disk that hangs.
SILENCE_S = 600.0
# Particles times steps in a second, on one core and at the least: 5 million were measured, a machine that is
# shared by 25 has this.
SLOWEST_PACE = 2e5
GRACE_S = 8.0  # between SIGTERM and SIGKILL to a child; mpirun itself gives its ranks 5 s
LINES_SHOWN = 12  # of a solver's log in an error message
ERROR_LINE = re.compile(r"ERROR|FATAL|error:|No space left|rror while loading")


def solver_environment() -> dict[str, str]:
    """Environment of the solvers; variables set by the user are kept.

    A job's SLURM is hidden, unless it starts the ranks (`LAUNCHER`): a single rank inside srun looks for it,
    and Debian's Open MPI then ends with an error.
    """
    hidden = () if os.environ.get(LAUNCHER) else ("SLURM_", "PMI")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(hidden)}
    environment.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    environment.setdefault("OMPI_MCA_rmaps_base_oversubscribe", "1")
    # a single rank needs no daemon beside it: half of the processor time of a start
    environment.setdefault("OMPI_MCA_ess_singleton_isolated", "1")
    # bedFoam's guards report an overflow with place and time; OpenFOAM's trap gives neither
    environment.setdefault("FOAM_SIGFPE", "false")
    # on a busy machine a waiting rank yields its core
    environment.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
    environment.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
    if os.geteuid() == 0:
        environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return environment


def on_ranks(command: list[str], ranks: int) -> list[str]:
    """The command line that runs a command on MPI ranks, by mpirun or by the user's `LAUNCHER`."""
    if launcher := shlex.split(os.environ.get(LAUNCHER, "")):
        return [*launcher, "-n", str(ranks), *command]
    return command if ranks == 1 else ["mpirun", "-np", str(ranks), *RANK_ENDS_WITH_MPIRUN, *command]


def longest_silence(particle_steps: float) -> float:
    """Time without a line of output after which a solver is taken to be stuck [s].

    Parameters
    ----------
    particle_steps : float
        Particles times the steps between two lines that it writes.
    """
    return max(SILENCE_S, particle_steps / SLOWEST_PACE)


def run_deck(
    deck: Path, variables: Mapping[str, object], log: Path, ranks: int = 1, silence_s: float | None = None
) -> None:
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
    silence_s : float, optional
        Of `run_logged`.

    Raises
    ------
    UserError
        As `run_logged`.
    """
    options = [word for name, value in variables.items() for word in ("-var", name, str(value))]
    command = on_ranks(["liggghts", "-in", str(deck), "-log", "none", *options], ranks)
    run_logged(command, log, silence_s=silence_s)


def run_logged(
    command: list[str],
    log: Path,
    each_line: Callable[[str], None] | None = None,
    variables: Mapping[str, str] | None = None,
    silence_s: float | None = None,
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
    silence_s : float, optional
        Time without a line after which it is ended; None waits for ever [s].

    Raises
    ------
    UserError
        The program is not installed, ends with an error, or is stuck: its error or last lines, and the log.
    """
    if shutil.which(command[0]) is None:
        raise UserError(
            f"the program {command[0]} is not installed: run ./run, which installs what is missing"
        )
    name = Path(command[0]).name
    with log.open("a", encoding="utf-8") as stream, _child(command, variables) as child:
        watchdog = Watchdog(child, silence_s)
        assert child.stdout is not None
        for line in child.stdout:
            watchdog.heard()
            stream.write(line)
            if each_line:
                each_line(line)
        code = child.wait()
        watchdog.rest()
    if watchdog.barked:
        raise UserError(
            f"{name} was ended: no line of output for {silence_s:g} s, so no progress; its last lines:\n"
            f"{last_lines(log)}\nits whole log: {log}"
        )
    if code != 0:
        raise UserError(f"{name} ended with code {code}:\n{error_lines(log)}\nits whole log: {log}")


@contextmanager
def _child(command: list[str], variables: Mapping[str, str] | None) -> Iterator[subprocess.Popen[str]]:
    """A child process that ends with the body, or with this process."""
    child = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        env=solver_environment() | dict(variables or {}),
        preexec_fn=child_ends_with_parent(),
        close_fds=False,  # a folder's lock is inherited: it holds until the last process in there has ended
    )
    try:
        yield child
    except BaseException:
        end(child)
        raise


def end(child: subprocess.Popen[str]) -> None:
    """End a child: by SIGTERM, and by SIGKILL if that is not enough."""
    child.terminate()
    try:
        child.wait(GRACE_S)
    except subprocess.TimeoutExpired:
        child.kill()
        child.wait()


class Watchdog:
    """Ends a child that has been silent for too long.

    Time in which this process is stopped does not count, nor time in which the child waits for a core: on a
    crowded machine it is slow, not stuck.

    Parameters
    ----------
    child : Popen
    silence_s : float or None
        Longest time without a line [s]; None watches nothing.
    """

    TICKS = 50  # of a silence; a stop of this process (Ctrl-Z, a sleeping laptop) costs one

    def __init__(self, child: subprocess.Popen[str], silence_s: float | None) -> None:
        self.child = child
        self.barked = False
        self._quiet_s = 0.0
        self._over = threading.Event()
        if silence_s is not None:
            threading.Thread(target=self._watch, args=(silence_s / self.TICKS,), daemon=True).start()

    def heard(self) -> None:
        """Take note of a line."""
        self._quiet_s = 0.0

    def rest(self) -> None:
        """End the watch."""
        self._over.set()

    def _watch(self, tick_s: float) -> None:
        waited_s = waiting_s(self.child.pid)
        while not self._over.wait(tick_s):
            before_s, waited_s = waited_s, waiting_s(self.child.pid)
            self._quiet_s += max(tick_s - max(waited_s - before_s, 0.0), 0.0)
            if self._quiet_s > (self.TICKS - 0.5) * tick_s:
                self.barked = True
                end(self.child)
                return


def waiting_s(process: int) -> float:
    """Time that a process and its descendants have been ready to run without a core, of the longest [s].

    It is the second number of ``/proc/<id>/schedstat`` (proc(5)); 0 where a kernel does not count it.
    """
    waits = [0.0]
    for number in (process, *descendants(process)):
        with suppress(OSError, IndexError, ValueError):
            waits.append(float(Path(f"/proc/{number}/schedstat").read_text().split()[1]) / 1e9)
    return max(waits)


def last_lines(log: Path) -> str:
    """The last lines of a log that are not empty, indented."""
    lines = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    return "\n".join("  " + line for line in lines[-3:])


def error_lines(log: Path) -> str:
    """Lines of a log from its first error on, or its last lines without one."""
    lines = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    first = next(
        (at for at, line in enumerate(lines) if ERROR_LINE.search(line)), max(len(lines) - LINES_SHOWN, 0)
    )
    return "\n".join("  " + line for line in lines[first : first + LINES_SHOWN])


def clock_text(seconds: float) -> str:
    """A time as hours, minutes and seconds."""
    whole = int(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def show_progress(name: str, now_s: float, end_s: float, cost: float, more: str = "") -> None:
    """A line on stderr: simulated time of the whole [s], wall time a simulated second [s], time left."""
    left = clock_text(cost * max(end_s - now_s, 0))
    text = f"{now_s:.3f} of {end_s:g} s simulated, {cost:.0f} s per simulated second, {left} left{more}"
    print(f"{name}: {text}", file=sys.stderr, flush=True)


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
        show_progress("run_dem", now_s, self.end_s, cost, f" ({progress[3].strip()})")
