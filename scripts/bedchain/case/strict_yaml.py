# SPDX-License-Identifier: GPL-3.0-or-later
"""Strict reading of YAML: decimal numbers, unique keys, few levels, and the line of every key and error."""

import math
import re
import unicodedata
from pathlib import Path
from typing import Any

import yaml

from bedchain.errors import CaseError, Problem, UserError

# tag of a plain word -> its pattern, and the letters that it starts with
PLAIN = {
    "null": (re.compile(r"(~|null|Null|NULL|)\Z"), ["~", "n", "N", ""]),
    "bool": (re.compile(r"(true|True|TRUE|false|False|FALSE)\Z"), list("tTfF")),
    "int": (re.compile(r"[-+]?(0|[1-9][0-9]*)\Z"), list("-+0123456789")),
    "float": (
        re.compile(
            r"[-+]?(((0|[1-9][0-9]*)(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?|\.inf|\.Inf|\.INF)\Z|\.(nan|NaN|NAN)\Z"
        ),
        list("-+.0123456789"),
    ),
}
GROUPS = ("seq", "map")
DEEPEST = 20  # levels of groups in a file; the schema has 9
SHOWN = 40  # letters of a value in a message [1]
TAG = "tag:yaml.org,2002:"
Lines = dict[str, int]


class StrictLoader(yaml.SafeLoader):
    """PyYAML's safe loader with the plain words of YAML 1.2: null, true, false, decimal numbers, text.

    PyYAML follows YAML 1.1, where 0700 is 448, 1:30 is 90, 1_000 is 1000, no is false, and 2e6 is text.
    A number with a leading zero is text here too, since readers of YAML differ about it.
    """

    yaml_implicit_resolvers: dict[str, list] = {}
    depth = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """The next node; deep nesting is an error of its own, since nodes are composed by recursion."""
        if self.depth == DEEPEST:
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            raise yaml.MarkedYAMLError(
                problem=f"groups within groups, over {DEEPEST} levels", problem_mark=mark
            )
        self.depth += 1
        node: yaml.Node | None = super().compose_node(parent, index)
        self.depth -= 1
        return node


for kind, (pattern, letters) in PLAIN.items():
    StrictLoader.add_implicit_resolver(TAG + kind, pattern, letters)


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
        The file is not YAML, or has a key twice, an alias of a group, a tag, deep nesting,
        a control character, or a number that is not finite.
    """
    text = _text(file)
    try:
        loader = StrictLoader(text)
    except yaml.reader.ReaderError as error:
        wrong = f"the character {chr(error.character)!a} is not allowed"
        raise _no_yaml(file, wrong, "take it out", text.count("\n", 0, error.position) + 1) from None
    try:
        root = loader.get_single_node()
        reader = _Reader(loader)
        data = reader.value(root, "") if root is not None else None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None) or loader.get_mark()
        wrong = getattr(error, "problem", None) or str(error)
        raise _no_yaml(file, wrong, "check indentation, colons and quotes", mark.line + 1) from None
    except (ValueError, OverflowError) as error:  # of an escape beyond Unicode
        raise _no_yaml(file, str(error), "correct the character", loader.line + 1) from None
    if reader.problems:
        raise CaseError(file, reader.problems)
    return data, reader.lines


def _text(file: Path) -> str:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise UserError(f"{file} cannot be read ({error}); check the name, it must be a text file") from None
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        wrong = f"line {line} holds the byte 0x{content[error.start]:02x}, which is no UTF-8"
        raise UserError(
            f"{file} cannot be read ({wrong}); it must be a text file, save it as UTF-8"
        ) from None


def _no_yaml(file: Path, wrong: str, remedy: str, line: int) -> CaseError:
    return CaseError(file, [Problem("(file)", f"no YAML: {wrong}", remedy, line)])


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
        if node.tag.removeprefix(TAG) not in GROUPS:
            return self._refuse_tag(node, path)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(item, f"{path}[{index}]") for index, item in enumerate(node.value)]
        return self._mapping(node, path)

    def _mapping(self, node: yaml.Node, path: str) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if not isinstance(key_node, yaml.ScalarNode):
                self._note(key_node, path, "has a group as a key", "a key is one word before a colon")
                continue
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
        text, kind = node.value, node.tag.removeprefix(TAG)
        if kind == "str":
            if control := next((letter for letter in text if _is_control(letter)), None):
                self._note(node, path, f"has the character {control!a} in it", "take it out")
            return text
        if kind not in PLAIN or not PLAIN[kind][0].match(text):
            return self._refuse_tag(node, path)
        if kind in ("int", "float"):
            return self._number(node, path)
        return None if kind == "null" else text.lower() == "true"

    def _refuse_tag(self, node: yaml.Node, path: str) -> None:
        self._note(node, path, f"has the tag {node.tag.replace(TAG, '!!')}", "leave the tag out")

    def _number(self, node: yaml.ScalarNode, path: str) -> int | float:
        value = float(node.value.lower().replace(".inf", "inf").replace(".nan", "nan"))
        if not math.isfinite(value):
            shown = node.value if len(node.value) <= SHOWN else f"{node.value[:SHOWN]}..."
            self._note(node, path, f"{shown} is not a finite number", "give a finite number")
            return value
        return int(node.value) if node.tag == TAG + "int" else value

    def _note(self, node: yaml.Node, path: str, wrong: str, remedy: str) -> None:
        self.problems.append(Problem(path or "(file)", wrong, remedy, node.start_mark.line + 1))


def _is_control(letter: str) -> bool:
    """Whether a letter is a control character or half of a surrogate pair, which no figure takes."""
    return letter not in "\n\t" and unicodedata.category(letter) in ("Cc", "Cs")
