# SPDX-License-Identifier: GPL-3.0-or-later
"""The life of a process: a job ends with the run that started it, however that ended.

A run is the snakemake of a user's line, or ``./test``; its process id is in the environment of its jobs. Only
what a run started is bound to it: a script that a user starts by hand outlives the shell.
"""

import ctypes
import os
import select
import signal
import threading
import time
from collections.abc import Callable
from types import FrameType

RUN = "BEDCHAIN_RUN"  # environment variable with the process id of the run
PR_SET_PDEATHSIG = 1  # of linux/prctl.h: signal to a child when its parent dies
PATIENCE_S = 4.0  # for a process to end by itself


def begin_run(submitted: bool = False) -> None:
    """Make this process the run that its jobs end with; it ends with the run that started it, if any.

    Parameters
    ----------
    submitted : bool
        Whether a cluster started it: the run in its environment is of the machine that submitted it.
    """
    if not submitted:
        end_with_run()
    os.environ[RUN] = str(os.getpid())


def end_with_run() -> None:
    """Have this process end by SIGTERM as soon as its run or its parent has ended, by SIGKILL if need be.

    The parent is a job's shell: snakemake may wait for the output of a shell that is no more.
    Without a run in the environment nothing is watched.
    """
    run = os.environ.get(RUN, "")
    if not run.isdecimal() or int(run) == os.getpid():
        return
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getpid() not in descendants(int(run)):  # one between the two has ended before the line above
        _end()
        return
    try:
        handle = os.pidfd_open(int(run))
    except ProcessLookupError:
        _end()
        return
    except OSError:  # a kernel or a container without it: the run must end its jobs itself
        return
    threading.Thread(target=_watch, args=(handle,), daemon=True, name="end_with_run").start()


def _watch(handle: int) -> None:
    select.select([handle], [], [])  # readable as soon as the process has ended
    _end()


def _end() -> None:
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(PATIENCE_S)
    os.kill(os.getpid(), signal.SIGKILL)


def child_ends_with_parent(signal_number: int = signal.SIGTERM) -> Callable[[], None]:
    """Function for ``preexec_fn`` of a child: it gets a signal as soon as the thread that started it ends."""
    parent = os.getpid()
    libc = ctypes.CDLL(None)

    def bind() -> None:
        libc.prctl(PR_SET_PDEATHSIG, signal_number)
        if os.getppid() != parent:  # it died before the line above
            os.kill(os.getpid(), signal.SIGKILL)

    return bind


def end_all_at_sigterm() -> None:
    """Have SIGTERM and SIGHUP end this process and all that it started, as Ctrl-C does; what stays is killed.

    Snakemake's own answer to SIGTERM waits for running jobs, which may take hours. Under nohup SIGHUP stays
    ignored.
    """
    signal.signal(signal.SIGTERM, _end_all)
    if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:
        signal.signal(signal.SIGHUP, _end_all)


def _end_all(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    processes = descendants(os.getpid())
    _signal_all(processes, signal.SIGINT)
    threading.Thread(target=_kill_later, args=(processes,), daemon=True).start()
    raise KeyboardInterrupt


def _kill_later(processes: list[int]) -> None:
    for sign in (signal.SIGTERM, signal.SIGKILL):
        time.sleep(PATIENCE_S / 2)
        _signal_all([*processes, *descendants(os.getpid())], sign)


def _signal_all(processes: list[int], number: int) -> None:
    for process in processes:
        try:
            os.kill(process, number)
        except ProcessLookupError:
            continue


def descendants(process: int) -> list[int]:
    """Ids of all processes that a process started, directly or through others, and that are still there."""
    children: dict[int, list[int]] = {}
    for name in filter(str.isdecimal, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as stream:
                parent = int(stream.read().rpartition(")")[2].split()[1])
        except (OSError, IndexError):
            continue
        children.setdefault(parent, []).append(int(name))
    waiting, below = [process], []
    while waiting:
        fresh = children.get(waiting.pop(), [])
        below += fresh
        waiting += fresh
    return below
