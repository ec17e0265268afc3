# SPDX-License-Identifier: GPL-3.0-or-later
"""Stages: an entry function called by the names of its rule, with one log and one exit for errors."""

import inspect
import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

from bedchain.errors import UserError, report_user_errors
from bedchain.fingerprints import check_noted, note_fingerprints, unreadable
from bedchain.lifetime import end_with_run

LOG = logging.getLogger("bedchain")


@contextmanager
def stage(log: Path | str) -> Iterator[None]:
    """Run a stage: what it reports goes to stderr and to its log, a user's error is one clear message.

    Parameters
    ----------
    log : path
        The rule's log file.

    Raises
    ------
    SystemExit
        Code 1, after a `UserError` or a `DataError`.
    """
    end_with_run()
    Path(log).parent.mkdir(parents=True, exist_ok=True)
    handlers: list[logging.Handler] = [logging.StreamHandler(), logging.FileHandler(log, mode="w")]
    for handler in handlers:
        handler.setFormatter(logging.Formatter("%(asctime)s %(message)s", "%H:%M:%S"))
        LOG.addHandler(handler)
    LOG.setLevel(logging.INFO)
    try:
        with report_user_errors(log):
            yield
    except Exception:
        LOG.exception("failed")
        raise
    finally:
        for handler in handlers:
            LOG.removeHandler(handler)
            handler.close()


def run_stage(function: Callable[..., object], rule: Any) -> None:
    """Call a stage's entry function by the names of its rule, inside `stage`.

    Parameters
    ----------
    function : callable
        Its parameters have the names of the rule's outputs, inputs, params and wildcards.
    rule : Snakemake's ``snakemake`` object
        Of the job.

    Raises
    ------
    SystemExit
        Code 1, after a `UserError` or a `DataError`.
    TypeError
        The rule lacks a name: a mistake in rule or script.
    """
    with stage(rule.log[0]):
        try:
            arguments = stage_arguments(function, rule_names(rule))
        except TypeError as error:
            raise TypeError(f"rule {rule.rule}: {error}") from error
        with known_files(_all_files(rule.input), _all_files(rule.output)):
            function(**arguments)


@contextmanager
def known_files(inputs: list[Path], outputs: list[Path]) -> Iterator[None]:
    """Work on files that are as their makers left them; leaves notes of the files that it makes.

    Parameters
    ----------
    inputs, outputs : list of Path

    Raises
    ------
    UserError
        An input is not as its note says; or the work ended with an error of the program, and an input cannot
        be read.
    """
    check_noted(inputs)
    try:
        yield
    except (UserError, OSError):
        raise
    except Exception as error:
        if (damaged := unreadable(inputs)) is None:
            raise
        file, wrong = damaged
        way_out = "move it away and give the same command again"
        raise UserError(f"{file} cannot be read ({wrong}): {way_out}") from error
    note_fingerprints(outputs)


def rule_names(rule: Any) -> dict[str, Any]:
    """Everything that a rule gives its script, by name; outputs and inputs as `Path` or list of `Path`."""
    names = dict(rule.wildcards.items()) | dict(rule.params.items())
    for files in (rule.input, rule.output):
        names |= {name: _paths(value) for name, value in files.items()}
    return names


def _all_files(names: Any) -> list[Path]:
    """All files that have a name in a rule."""
    lists = (_paths(files) for _, files in names.items())
    return [file for part in lists for file in (part if isinstance(part, list) else [part])]


def _paths(files: Any) -> Path | list[Path]:
    return Path(files) if isinstance(files, str) else [Path(file) for file in files]


def stage_arguments(function: Callable[..., object], names: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of an entry function, looked up by the names of its parameters.

    A parameter whose type is a dataclass or a named tuple is made from the mapping of its name where there
    is one, else from the names of its fields. A parameter with a default may be missing.

    Parameters
    ----------
    function : callable
        An entry function, or a dataclass or named tuple.
    names : mapping of str to object
        Of `rule_names`.

    Returns
    -------
    dict of str to object

    Raises
    ------
    TypeError
        A name is missing, or a mapping has other names than the fields.
    """
    arguments: dict[str, Any] = {}
    for parameter in inspect.signature(function, eval_str=True).parameters.values():
        name, kind = parameter.name, parameter.annotation
        if _has_fields(kind):
            arguments[name] = kind(**stage_arguments(kind, _names_for(kind, name, names)))
        elif name in names:
            arguments[name] = Path(names[name]) if kind is Path else names[name]
        elif parameter.default is parameter.empty:
            raise TypeError(f"{function.__name__} takes {name!r}; there are {', '.join(sorted(names))}")
    return arguments


def _has_fields(kind: Any) -> bool:
    return isinstance(kind, type) and (is_dataclass(kind) or hasattr(kind, "_fields"))


def _names_for(kind: type, name: str, names: Mapping[str, Any]) -> Mapping[str, Any]:
    """Where the fields of a value object are looked up: in the mapping of a name, or among all names."""
    mapping = names.get(name)
    if not isinstance(mapping, Mapping):
        return names
    if others := mapping.keys() - inspect.signature(kind).parameters.keys():
        raise TypeError(f"{name!r} gives {', '.join(sorted(others))}, which {kind.__name__} does not take")
    return mapping
