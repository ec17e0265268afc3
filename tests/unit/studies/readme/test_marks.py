# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables between marks."""

from pathlib import Path

import pytest

from bedchain.errors import UserError
from bedchain.studies.readme.marks import filled, named_files

CSV = 'what,value,machine,commit\ntime,"3 s, cold",EPYC,abc\n'
FILLED = """before
<!-- table: t/a.csv -->
| what | value |
| --- | --- |
| time | 3 s, cold |

<sub>EPYC, commit abc</sub>
<!-- end -->
after
"""


def folder(tmp_path: Path, content: str = CSV) -> Path:
    (tmp_path / "t").mkdir()
    (tmp_path / "t/a.csv").write_text(content)
    return tmp_path


def test_a_table_replaces_whatever_stands_between_its_marks(tmp_path: Path) -> None:
    text = "before\n<!-- table: t/a.csv -->\nold\n<!-- end -->\nafter\n"
    assert filled(text, folder(tmp_path)) == FILLED
    assert filled(FILLED, tmp_path) == FILLED
    assert named_files(text) == ["t/a.csv"]


def test_an_empty_block_and_a_text_without_marks(tmp_path: Path) -> None:
    root = folder(tmp_path)
    assert filled("before\n<!-- table: t/a.csv -->\n<!-- end -->\nafter\n", root) == FILLED
    assert filled("no marks\n", root) == "no marks\n"


def test_a_bar_in_a_cell_does_not_end_it(tmp_path: Path) -> None:
    root = folder(tmp_path, "what,source\n|x|,y\n")
    assert r"| \|x\| |" in filled("<!-- table: t/a.csv -->\n<!-- end -->", root)


def test_each_origin_is_said_once(tmp_path: Path) -> None:
    root = folder(tmp_path, "what,machine,source\na,EPYC,\nb,EPYC,\nc,,README of commit x\n")
    end = filled("<!-- table: t/a.csv -->\n<!-- end -->", root).splitlines()[-2]
    assert end == "<sub>EPYC; README of commit x</sub>"


@pytest.mark.parametrize(
    "text", ["<!-- table: t/a.csv -->\nold\n", "<!-- end -->\n", "<!-- table:t/a.csv -->\n<!-- end -->"]
)
def test_a_mark_alone_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(UserError, match="lacks one of its marks"):
        filled(text, folder(tmp_path))


def test_a_file_that_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="there is no t/b.csv"):
        filled("<!-- table: t/b.csv -->\n<!-- end -->", tmp_path)


def test_a_row_longer_than_its_header_is_refused(tmp_path: Path) -> None:
    (tmp_path / "costs.csv").write_text("bed,cost,source\nshort,1,a run, and another\n")
    with pytest.raises(UserError, match=r"costs\.csv has rows longer .* quotes"):
        filled("<!-- table: costs.csv -->\n<!-- end -->", tmp_path)
