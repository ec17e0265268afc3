# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the study peers, ``--config peers=...``, as words of a shell line."""

import math
import shlex
from collections.abc import Collection, Mapping
from typing import Any

from bedchain.errors import UserError, guess

# options of the study peers -> kind
PEERS = {"beds": "cases", "repeats": "count", "duration": "number", "longest": "number", "start": "number"}
PEERS_REMEDY = "take --config peers='{beds: short, repeats: 3}', with " + ", ".join(PEERS)


def peers_options(option: object, cases: Collection[str]) -> str:
    """Options of compare_peers.py from ``--config peers='{repeats: 5}'``, quoted for a shell.

    Parameters
    ----------
    option : mapping, optional
    cases : collection of str
        Names of all cases.

    Returns
    -------
    str
        Such as ``--repeats 5``.

    Raises
    ------
    UserError
        An unknown option, or a value that it cannot have.
    """
    if option is not None and not isinstance(option, Mapping):
        raise UserError(f"peers is {option!r}: {PEERS_REMEDY}")
    words: list[str] = []
    for key, value in (option or {}).items():
        if key not in PEERS:
            raise UserError(f"peers has no {key!r}{guess(key, PEERS)}: {PEERS_REMEDY}")
        check = _checked_beds if PEERS[key] == "cases" else _checked_number
        words += [f"--{key}", *check(key, value, cases)]
    return shlex.join(words)


def _checked_beds(key: str, value: object, cases: Collection[str]) -> list[str]:
    names: list[Any] = value if isinstance(value, list) else [value]
    if not names:
        raise UserError(f"peers.{key} names no case: take of {', '.join(cases)}")
    for name in names:
        if name not in cases:
            near = guess(str(name), cases)
            raise UserError(f"peers.{key}: there is no case {name!r}{near}: take of {', '.join(cases)}")
    return names


def _checked_number(key: str, value: object, _: Collection[str]) -> list[str]:
    kind, wanted = (int, "whole number") if PEERS[key] == "count" else (float, "number")
    try:
        number = kind(str(value))
    except ValueError:
        number = 0
    if not (math.isfinite(number) and number > 0):
        raise UserError(f"peers.{key} is {value!r}, not a {wanted} above 0: {PEERS_REMEDY}")
    return [str(value)]
