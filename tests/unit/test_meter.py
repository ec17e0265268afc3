# SPDX-License-Identifier: GPL-3.0-or-later
"""The peak of the memory rises with what is allocated; processor time of a child counts when it has ended."""

import os
import subprocess
import sys

import numpy as np
import pytest

from bedchain.meter import children_cpu_s, forget_peak, peak_memory_mb

BLOCK_MB = 200.0


def test_peak_holds_a_block_that_was_freed():
    before = peak_memory_mb()
    block = np.ones(int(BLOCK_MB * 1e6 / 8))
    del block
    assert peak_memory_mb() >= before
    assert peak_memory_mb() > BLOCK_MB
    assert peak_memory_mb(os.getpid()) == pytest.approx(peak_memory_mb(), rel=0.01)
    if forget_peak():
        assert peak_memory_mb() < before + BLOCK_MB / 2


def test_a_process_that_has_ended_has_no_peak():
    with pytest.raises(OSError):
        peak_memory_mb(2**22 + 1)


def test_processor_time_is_that_of_the_child_and_of_its_own():
    busy = "import time\nwhile time.process_time() < 0.3: pass"
    before_s = children_cpu_s()
    subprocess.run(["sh", "-c", f'"{sys.executable}" -S -c "{busy}"; sleep 0.2'], check=True)
    assert 0.29 < children_cpu_s() - before_s < 0.6


def test_freed_memory_is_kept_where_asked():
    code = "\n".join(
        (
            "import resource, numpy as np, sys",
            "from bedchain.meter import keep_freed_memory",
            "keep_freed_memory() if sys.argv[1:] else None",
            "np.ones(1_000_000)",
            "before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt",
            "for _ in range(20): np.ones(1_000_000)",
            "print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)",
        )
    )
    faults = [
        int(subprocess.run([sys.executable, "-c", code, *words], cwd="scripts", capture_output=True).stdout)
        for words in ([], ["kept"])
    ]
    assert faults[1] < 100 < faults[0]
