# SPDX-License-Identifier: GPL-3.0-or-later
"""Each module of the library has a test file of its name, or a reason in tests/README.md."""

import ast
import re
from pathlib import Path

from made import ROOT

LIBRARY, UNIT = ROOT / "scripts" / "bedchain", ROOT / "tests" / "unit"
# tests of the code as a whole
OF_ALL = ("test_mirror.py", "test_layout.py", "test_readme.py")
# | `studies/peers/yade.py` | why it has no test file |
REASON = re.compile(r"^\| `([\w/]+\.py)` \| ([^|]+) \|$", re.MULTILINE)


def modules() -> set[str]:
    """Modules that hold more than a docstring; inputs of other programs are none of the library."""
    files = [file for file in LIBRARY.rglob("*.py") if "inputs" not in file.parts]
    with_code = [file for file in files if len(ast.parse(file.read_text(encoding="utf-8")).body) > 1]
    return {file.relative_to(LIBRARY).as_posix() for file in with_code}


def file_of(module: str) -> Path:
    """Where the tests of a module are."""
    return UNIT / Path(module).with_name(f"test_{Path(module).name}")


def reasons() -> dict[str, str]:
    return dict(REASON.findall((ROOT / "tests" / "README.md").read_text(encoding="utf-8")))


def test_every_module_has_a_test_file_or_a_reason():
    assert len(modules()) > 100
    assert not sorted(module for module in modules() - reasons().keys() if not file_of(module).exists())


def test_every_reason_is_needed():
    gone = sorted(reasons().keys() - modules())
    tested = sorted(module for module in reasons() if file_of(module).exists())
    assert reasons() and (gone, tested) == ([], [])


def test_every_test_file_has_its_module():
    files = {file for file in UNIT.rglob("test_*.py") if file.name not in OF_ALL}
    assert not sorted(str(file.relative_to(UNIT)) for file in files - {*map(file_of, modules())})
