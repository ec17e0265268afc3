# SPDX-License-Identifier: GPL-3.0-or-later
"""Waiting for what other processes do."""

import time
from collections.abc import Callable

DEADLINE_S = 20.0  # far above what is waited for, on a machine that is busy


def wait_until(happened: Callable[[], bool], deadline_s: float = DEADLINE_S) -> None:
    """Wait until something has happened.

    Raises
    ------
    AssertionError
        It has not at the deadline.
    """
    last = time.monotonic() + deadline_s
    while not happened():
        assert time.monotonic() < last, "it has not happened before the deadline"
        time.sleep(0.01)
