# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the stability study: values, limit by theory, and run."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from bedchain.errors import UserError
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import Verdict

ON = "on"  # all guards on, as by default
Known = Mapping[str, Mapping[str, float]]


def is_of_chains(group: str) -> bool:
    """Whether a group of settings is of chains, not of solvers."""
    return group.startswith("chain")


@dataclass(frozen=True)
class StabilitySetting:
    """A setting at an extreme.

    Attributes
    ----------
    group : str
        Number that is varied.
    name : str
        Unique within the study.
    values : dict
        Columns of the table, by name and unit.
    limit : Limit
        By theory.
    run : callable
        Takes a folder to work in and the observed values of other settings, returns a `Verdict`.
    inputs : str
        All that the result depends on besides the sources, as text.
    guards : str
        `ON`, or the guard that is off.
    needs : str
        Name of the setting that this one is compared with; empty for none.
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


def chosen(settings: list[StabilitySetting], groups: Iterable[str], reduced: bool) -> list[StabilitySetting]:
    """Settings of some groups, with those that they are compared with, in the order of the study.

    Parameters
    ----------
    settings : list of StabilitySetting
    groups : iterable of str
        Names of groups; empty for all.
    reduced : bool
        Only the reduced set.

    Raises
    ------
    UserError
        Unknown group; lists the known ones.
    """
    known = list(dict.fromkeys(setting.group for setting in settings))
    wanted = set(groups) or set(known)
    if unknown := sorted(wanted - set(known)):
        raise UserError(f"there is no group {', '.join(unknown)}: take one of {', '.join(known)}")
    some = [item for item in settings if item.group in wanted and (item.reduced or not reduced)]
    names = {item.name for item in some} | {item.needs for item in some}
    return [item for item in settings if item.name in names]
