# SPDX-License-Identifier: GPL-3.0-or-later
"""Files behind a script and other inputs of rules."""

import ast
from pathlib import Path

import pytest

from bedchain.rule_files import code, dated, imported_files, module_files, runs_code, source_files
from made import ROOT

LIBRARY = {
    "__init__.py": '"""Docstring only."""\n',
    "errors.py": "",
    "files.py": "import bedchain.errors\n",
    "physics/__init__.py": "",
    "physics/contacts.py": "import numpy as np\n",
    "case/__init__.py": '"""A package with code."""\n\nfrom bedchain.files import atomic_file\n',
    "case/load.py": "def load():\n    from bedchain.physics import contacts\n",
    "dem/__init__.py": "from bedchain.errors import UserError\n",
    "dem/drum.py": "from bedchain.dem import disk\n",
    "dem/disk.py": "from bedchain.dem import drum\n",
}


@pytest.fixture
def behind(tmp_path, monkeypatch):
    """Library files behind a script of some lines, in a library of a few modules."""
    for name, text in LIBRARY.items():
        (tmp_path / "scripts/bedchain" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "scripts/bedchain" / name).write_text(text)
    monkeypatch.chdir(tmp_path)

    def forget():
        for cached in (imported_files, module_files, runs_code):
            cached.cache_clear()

    def files(text):
        (tmp_path / "scripts/draw.py").write_text(text)
        forget()
        return {file.removeprefix("scripts/bedchain/") for file in code("draw")}

    yield files
    forget()


@pytest.mark.parametrize(
    ("text", "files"),
    [
        ("import os, json\nfrom numpy import errors\n", set()),
        ("import bedchain.errors\n", {"errors.py"}),
        ("import bedchain.errors as e, bedchain.files\n", {"errors.py", "files.py"}),
        ("from bedchain import errors\n", {"errors.py"}),
        ("from bedchain.errors import UserError\n", {"errors.py"}),
        ("from bedchain.physics import contacts\n", {"physics/contacts.py"}),
        ("import bedchain.physics.contacts\n", {"physics/contacts.py"}),
        ("from bedchain.physics.contacts import stiffness\n", {"physics/contacts.py"}),
        ("def draw():\n    if draw:\n        import bedchain.errors\n", {"errors.py"}),
        ("from bedchain.files import atomic_file\n", {"files.py", "errors.py"}),
        ("from bedchain import (  # two\n    errors,\n    files,\n)\n", {"errors.py", "files.py"}),
        ("from bedchain import errors, \\\n    files\n", {"errors.py", "files.py"}),
        ("import json as j, bedchain.errors\n", {"errors.py"}),
        ('"""Prose:\nfrom bedchain on, import of bedchain.\n"""\n', set()),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_every_form_of_import_is_followed(behind, text, files):
    assert behind(text) == files


def by_whole_files(file):
    """Names that a file imports of the library, by parsing all of it."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (node.module, *(f"{node.module}.{alias.name}" for alias in node.names))


def test_no_import_of_the_scripts_is_missed(monkeypatch):
    monkeypatch.chdir(ROOT)
    files = sorted(Path("scripts").rglob("*.py"))
    assert len(files) > 200
    for file in files:
        library = [name for name in by_whole_files(file) if name.split(".")[0] == "bedchain"]
        assert imported_files(file) == {source for name in library for source in module_files(name)}, file


def test_a_package_counts_where_it_holds_more_than_a_docstring(behind):
    assert behind("from bedchain.case.load import load\n") == {
        *("case/__init__.py", "case/load.py", "files.py", "errors.py", "physics/contacts.py")
    }
    assert behind("import bedchain.dem\n") == {"dem/__init__.py", "errors.py"}


def test_no_package_of_the_library_runs_code_so_that_an_edit_of_its_glossary_reruns_nothing():
    packages = sorted((ROOT / "scripts" / "bedchain").rglob("__init__.py"))
    assert packages and not [file for file in packages if runs_code(file)]


def test_modules_that_import_each_other_are_followed_once(behind):
    assert behind("import bedchain.dem.disk\n") == {
        "dem/__init__.py",
        "errors.py",
        "dem/drum.py",
        "dem/disk.py",
    }


def test_dated_files_change_with_their_time(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").touch()
    before = dated("*.csv", "*.tsv")
    assert list(before) == ["a.csv"] and dated("*.csv") == before
    (tmp_path / "b.tsv").touch()
    assert list(dated("*.csv", "*.tsv")) == ["a.csv", "b.tsv"]


def test_sources_are_sorted_and_without_links(tmp_path):
    (tmp_path / "sub").mkdir()
    for name in ("b.C", "sub/a.C", "c.o"):
        (tmp_path / name).touch()
    (tmp_path / "link.C").symlink_to(tmp_path / "b.C")
    assert source_files(str(tmp_path), "*.C") == [f"{tmp_path}/b.C", f"{tmp_path}/sub/a.C"]
