# SPDX-License-Identifier: GPL-3.0-or-later
"""Strict reading of YAML: numbers as in YAML 1.2, unique keys, and the line of every key."""

import math
import re
from pathlib import Path
from typing import Any

import yaml
from yaml.reader import ReaderError

from bedchain.errors import CaseError, Problem, UserError

FLOAT = re.compile(r"^[-+]?(\d[\d_]*\.?[\d_]*|\.\d[\d_]*)[eE][-+]?\d+$")
Lines = dict[str, int]


class StrictLoader(yaml.SafeLoader):
    """PyYAML's safe loader, except that ``2e6`` is a number (YAML 1.1, and so PyYAML, reads it as text)."""


StrictLoader.add_implicit_resolver("tag:yaml.org,2002:float", FLOAT, list("-+.0123456789"))


def read_yaml(file: Path) -> tuple[Any, Lines]:
    """Contents of a YAML file, and the line of each key.

    Parameters
    ----------
    file : Path
        UTF-8 text.

    Returns
    -------
    data : dict, list or scalar
        The contents; None for an empty file.
    lines : dict of str to int
        Dotted path of each key -> line, from 1.

    Raises
    ------
    UserError
        The file is missing or not text.
    CaseError
        Where it is no YAML, or holds a key twice, an alias of a group, a number that is not finite, or a
        text that its kind of value cannot be.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{file} cannot be read ({error}); check the name, it must be a text file") from None
    loader = None
    try:
        loader = StrictLoader(text)
        root = loader.get_single_node()
        reader = _Reader(loader)
        data = reader.value(root, "") if root is not None else None
    except (yaml.YAMLError, OverflowError, RecursionError) as error:
        raise CaseError(file, [_no_yaml(error, text, loader)]) from None
    if reader.problems:
        raise CaseError(file, reader.problems)
    return data, reader.lines


def _no_yaml(error: Exception, text: str, loader: StrictLoader | None) -> Problem:
    """Problem of a file that cannot be taken apart, with its line."""
    mark = getattr(error, "problem_mark", None)
    wrong = getattr(error, "problem", None) or str(error)
    line = mark.line + 1 if mark else loader.line + 1 if loader else None
    if isinstance(error, ReaderError):
        wrong = f"the character {chr(error.character)!a} is not allowed"
        line = text.count("\n", 0, error.position) + 1
    elif isinstance(error, RecursionError):
        wrong = "its groups are nested too deeply"
    return Problem("(file)", f"no YAML: {wrong}", "check indentation, colons and quotes", line)


class _Reader:
    """Values of YAML nodes, with the lines of their keys and the problems met."""

    def __init__(self, loader: StrictLoader) -> None:
        self.loader = loader
        self.lines: Lines = {}
        self.problems: list[Problem] = []
        self._seen: set[int] = set()

    def value(self, node: yaml.Node, path: str) -> Any:
        if isinstance(node, yaml.ScalarNode):
            return self._scalar(node, path)
        if id(node) in self._seen:
            self._note(node, path, "is an alias of another group", "write it out")
            return None
        self._seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            return [self.value(item, f"{path}[{index}]") for index, item in enumerate(node.value)]
        return self._mapping(node, path)

    def _mapping(self, node: yaml.Node, path: str) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key_node, value_node in node.value:
            key = str(key_node.value)
            inner = f"{path}.{key}" if path else key
            if key in data:
                wrong = f"is there twice, first in line {self.lines[inner]}"
                self._note(key_node, inner, wrong, "keep one of the two")
                continue
            self.lines[inner] = key_node.start_mark.line + 1
            data[key] = self.value(value_node, inner)
        return data

    def _scalar(self, node: yaml.ScalarNode, path: str) -> Any:
        try:
            value = self.loader.construct_object(node)
        except (ValueError, LookupError, AttributeError):
            # such as the 30th of February, or a tag that does not go with the text
            kind = node.tag.rpartition(":")[2]
            self._note(
                node, path, f"{node.value} cannot be read as {kind}", "put it into quotes, or correct it"
            )
            return None
        if isinstance(value, float) and not math.isfinite(value):
            self._note(node, path, f"{node.value} is not a finite number", "give a finite number")
        return value

    def _note(self, node: yaml.Node, path: str, wrong: str, remedy: str) -> None:
        self.problems.append(Problem(path or "(file)", wrong, remedy, node.start_mark.line + 1))
