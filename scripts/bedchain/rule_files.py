# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a rule depends on: the library behind its script, sources of other programs, dated records."""

import ast
import re
from functools import cache
from pathlib import Path

SCRIPTS = Path("scripts")
LIBRARY = "bedchain"
# a statement that imports from the library; parsing each file whole took a quarter of snakemake's start
NAMED = r"\w[\w.]*(?:[ \t]+as[ \t]+\w+)?[ \t]*,[ \t]*"
IMPORT = re.compile(
    rf"^[ \t]*((?:from[ \t]+{LIBRARY}[\w.]*[ \t]+import|import[ \t]+(?:{NAMED})*{LIBRARY})\b"
    r"(?:[^\n(\\]|\\\n|\([^)]*\))*)",
    re.MULTILINE,
)


def code(script: str) -> list[str]:
    """Library files that a script imports, directly or through others, as inputs of its rule.

    Parameters
    ----------
    script : str
        Its name, such as ``"assign_cells"``.

    Returns
    -------
    list of str
        Paths, sorted; a change in any of them reruns the rule.
    """
    return files_behind(SCRIPTS / f"{script}.py")


def files_behind(file: Path) -> list[str]:
    """Library files that a Python file imports, directly or through others, sorted."""
    behind: set[Path] = set()
    waiting = [file]
    while waiting:
        fresh = imported_files(waiting.pop()) - behind
        behind |= fresh
        waiting += fresh
    return sorted(map(str, behind))


@cache
def imported_files(file: Path) -> frozenset[Path]:
    """Library files that a Python file itself imports, wherever in it the imports stand."""
    names: set[str] = set()
    statements = IMPORT.findall(file.read_text(encoding="utf-8"))
    for node in ast.parse("\n".join(statements)).body:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    library = [name for name in names if name.split(".")[0] == LIBRARY]
    return frozenset(source for name in library for source in module_files(name))


@cache
def module_files(name: str) -> tuple[Path, ...]:
    """The file of a module, and those of the packages around it that hold more than a docstring.

    Parameters
    ----------
    name : str
        Dotted; what is no module (a function, a class) has no file of its own.
    """
    parts = name.split(".")
    packages = [SCRIPTS.joinpath(*parts[:end], "__init__.py") for end in range(1, len(parts) + 1)]
    files = [file for file in packages if file.exists() and runs_code(file)]
    module = SCRIPTS.joinpath(*parts).with_suffix(".py")
    return (*files, module) if module.exists() else tuple(files)


@cache
def runs_code(file: Path) -> bool:
    """Whether a Python file holds anything besides its docstring."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return len(tree.body) > (ast.get_docstring(tree, clean=False) is not None)


def dated(*patterns: str) -> dict[str, int]:
    """Files that match any of the patterns, with their times: so a rule sees that one changed.

    Parameters
    ----------
    *patterns : str
        Relative to the repository, such as ``"results/*/dem.json"``.

    Returns
    -------
    dict
        Path -> time of its last change [ns].
    """
    return {
        str(file): file.stat().st_mtime_ns for pattern in patterns for file in sorted(Path().glob(pattern))
    }


def source_files(folder: str, *patterns: str) -> list[str]:
    """Files below a folder whose names match any of the patterns, sorted, without links that builds make.

    Parameters
    ----------
    folder : str
        Relative to the repository.
    *patterns : str
        Such as ``"*.C"``.
    """
    files = {file for pattern in patterns for file in Path(folder).rglob(pattern)}
    return sorted(str(file) for file in files if file.is_file() and not file.is_symlink())
