# SPDX-License-Identifier: GPL-3.0-or-later
"""One setting of the study: what it is, the limit by theory, and how it is tried."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from bedchain.errors import UserError
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import Verdict

ON = "on"  # guards as they come
Known = Mapping[str, Mapping[str, float]]


def is_of_chains(group: str) -> bool:
    """Whether a group of settings tries chains, and not solvers."""
    return group.startswith("chain")


@dataclass(frozen=True)
class Setting:
    """A setting at some extreme.

    Attributes
    ----------
    group : str
        What is varied.
    name : str
        Unique within the study.
    values : dict
        Columns of the table, by name and unit.
    limit : Limit
        By theory.
    run : callable
        From a folder to work in and what was observed in other settings to a `Verdict`.
    inputs : str
        All that decides about the result beside the sources, as text.
    guards : str
        `ON`, or the guard that is off.
    needs : str
        Setting that this one is compared with; empty for none.
    reduced : bool
        Whether it is in the reduced set.
    """

    group: str
    name: str
    values: dict[str, float | str]
    limit: Limit
    run: Callable[[Path, Known], Verdict]
    inputs: str
    guards: str = ON
    needs: str = ""
    reduced: bool = field(default=False, compare=False)


def chosen(settings: list[Setting], groups: Iterable[str], reduced: bool) -> list[Setting]:
    """Some of the settings, with those that they are compared with, in the order of the study.

    Parameters
    ----------
    settings : list of Setting
    groups : iterable of str
        Names of groups; none means all.
    reduced : bool
        Only the reduced set.

    Raises
    ------
    UserError
        There is no group of a name: lists those that there are.
    """
    known = list(dict.fromkeys(setting.group for setting in settings))
    wanted = set(groups) or set(known)
    if unknown := sorted(wanted - set(known)):
        raise UserError(f"there is no group {', '.join(unknown)}: take one of {', '.join(known)}")
    some = [item for item in settings if item.group in wanted and (item.reduced or not reduced)]
    names = {item.name for item in some} | {item.needs for item in some}
    return [item for item in settings if item.name in names]
