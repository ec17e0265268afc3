# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory of the machine, peak of a process, processor time of children, as the system keeps them."""

import contextlib
import ctypes
import os
import re
import resource
import threading
from pathlib import Path

BYTES_IN_KB, BYTES_IN_MB = 1024, 1e6
# of proc(5), clear_refs: the record of the highest memory use starts again
CLEAR_PEAK = "5"
# of malloc.h: keys of mallopt(3), and the largest value that it takes
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, LARGEST_INT = -1, -3, 2**31 - 1
PEAK = re.compile(r"^VmHWM:\s+(\d+) kB$", re.M)


def physical_memory_bytes() -> int:
    """Memory of the machine [bytes]."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def peak_memory_mb(process: int | str = "self") -> float:
    """Largest resident memory of a process so far [MB of 10^6 bytes]; 0 where the system does not say.

    Not `resource.getrusage`: what it gives to a fresh process starts at the peak of the one that started it.

    Parameters
    ----------
    process : int or str
        Number of a process; this one by default.

    Raises
    ------
    OSError
        The process has ended.
    """
    match = PEAK.search((Path("/proc") / str(process) / "status").read_text(errors="replace"))
    return int(match[1]) * BYTES_IN_KB / BYTES_IN_MB if match else 0.0


def children_peak_mb() -> float:
    """Largest `peak_memory_mb` of the processes that this thread has started and that run; 0 without any."""
    listed = Path(f"/proc/self/task/{threading.get_native_id()}/children")
    peaks = [0.0]
    try:
        for process in listed.read_text().split():
            peaks.append(peak_memory_mb(process))
    except OSError:  # ended meanwhile, or a system that keeps no such list
        pass
    return max(peaks)


def children_cpu_s() -> float:
    """Processor time of the children of this process that have ended, and of theirs [s]."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def forget_peak() -> bool:
    """Start the record of this process's peak again; whether the system lets us."""
    try:
        Path("/proc/self/clear_refs").write_text(CLEAR_PEAK)
    except OSError:
        return False
    return True


def keep_freed_memory() -> None:
    """Have this process keep the memory of arrays that it frees, for the next ones.

    Each large array is otherwise memory that the system must clear first: a fifth of the processor time of
    work that makes many of them. The peak stays, but the memory between peaks is not given back.
    """
    libc = ctypes.CDLL(None)
    with contextlib.suppress(AttributeError):  # of glibc only
        for key in (M_TRIM_THRESHOLD, M_MMAP_THRESHOLD):
            libc.mallopt(key, LARGEST_INT)
