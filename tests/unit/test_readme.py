# SPDX-License-Identifier: GPL-3.0-or-later
"""The README files: each table as its csv file has it, no dead link, a short first page."""

import re
from importlib import import_module
from operator import attrgetter
from pathlib import Path

import pandas as pd
import pytest

from bedchain.studies.readme.marks import ORIGIN, filled, named_files
from made import ROOT

READMES = sorted(
    {file for pattern in ("README.md", "*/README.md", "cases/*/README.md") for file in ROOT.glob(pattern)}
    - {file for name in ("results", "logs") for file in ROOT.glob(f"{name}/**/README.md")}
)
TABLES = sorted(ROOT.glob("*/tables/*.csv")) + sorted(ROOT.glob("cases/*/tables/*.csv"))
LINES = 150  # of the README at the door
NUMBERS = 8  # of its table


def named(file: Path) -> str:
    return str(file.relative_to(ROOT))


@pytest.mark.parametrize("readme", READMES, ids=named)
def test_each_table_is_as_its_csv_file_has_it(readme: Path) -> None:
    text = readme.read_text(encoding="utf-8")
    assert filled(text, ROOT) == text, f"{named(readme)}: run ./run readme"


@pytest.mark.parametrize("readme", READMES, ids=named)
def test_each_link_leads_somewhere(readme: Path) -> None:
    links = re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", readme.read_text(encoding="utf-8"))
    assert [link for link in links if not (readme.parent / link).exists()] == []


@pytest.mark.parametrize("table", TABLES, ids=named)
def test_each_row_says_where_it_is_from(table: Path) -> None:
    rows = pd.read_csv(table, dtype=str, keep_default_na=False)
    origin = rows.reindex(columns=ORIGIN, fill_value="")
    assert (origin["commit"].ne("") | origin["source"].ne("")).all()


def test_each_table_is_shown() -> None:
    shown = {name for readme in READMES for name in named_files(readme.read_text(encoding="utf-8"))}
    assert shown == {named(table) for table in TABLES}


def test_the_first_page_is_short() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LINES
    (name,) = named_files(text)
    assert len(pd.read_csv(ROOT / name)) <= NUMBERS


def test_each_function_of_the_walk_exists() -> None:
    rooms = "|".join(folder.name for folder in (ROOT / "scripts/bedchain").iterdir() if folder.is_dir())
    text = (ROOT / "scripts/README.md").read_text(encoding="utf-8")
    names = re.findall(rf"`((?:{rooms})\.\w+)\.([\w.]+)`", text)
    assert len(names) > 10
    for module, function in names:
        assert attrgetter(function)(import_module(f"bedchain.{module}")), f"{module}.{function}"
