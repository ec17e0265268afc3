# SPDX-License-Identifier: GPL-3.0-or-later
"""The registry of checks on a case: each with the keys whose values it gets."""

from collections.abc import Callable, Iterator

Finding = tuple[str, str, str]  # dotted key, wrong value, remedy
Check = Callable[..., Iterator[Finding]]
CHECKS: list[tuple[tuple[str, ...], Check]] = []


def reads(*keys: str) -> Callable[[Check], Check]:
    """Register a check that gets the values of these dotted keys and yields a `Finding` for each problem."""

    def register(check: Check) -> Check:
        CHECKS.append((keys, check))
        return check

    return register
