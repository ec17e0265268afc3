# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables in the ways that people write them: separators, headers, preambles, times, and tracks."""

import io

import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms import table
from bedchain.trajectory.forms.streams import Source

ROWS = [(0.0, 1, 0.1, 0.2), (0.0, 2, 0.3, 0.4), (0.5, 1, 0.5, 0.6), (0.5, 2, 0.7, 0.8)]


def read(text: str, names=None):
    source = Source(io.BytesIO(text.encode()))
    layout = table.layout_of(source, names)
    return list(table.read_frames(source, layout, {}))


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   "])
@pytest.mark.parametrize("before", ["", "# ", "EXTRACTED DATA\n\n", "\ufeff"])
def test_a_long_table_is_cut_into_frames(separator, before, monkeypatch):
    monkeypatch.setattr(table, "ROWS", 3)  # frames go across the chunks
    header = before + separator.join(("time", "id", "x", "z"))
    frames = read("\n".join([header, *(separator.join(map(str, row)) for row in ROWS)]) + "\n")
    assert [(frame.time, frame.number) for frame in frames] == [(0.0, 2), (0.5, 2)]
    assert frames[1].load()["x"].tolist() == [0.5, 0.7] and frames[1].columns == ("id", "x", "z")


def test_a_table_without_time_is_one_frame_and_words_are_no_columns_of_use():
    (frame,) = read("id,kind,x,z\n1,glass,0.1,0.2\n2,steel,0.3,0.4")
    assert (frame.time, frame.number) == (None, 2) and frame.load()["z"].tolist() == [0.2, 0.4]


def test_a_track_is_a_frame_a_row():
    frames = read("# t x y z error\n1.5 1 2 3 9\n1.75 4 5 6 9\n")
    assert [(frame.time, frame.number) for frame in frames] == [(1.5, 1), (1.75, 1)]


def test_a_bare_table_asks_for_names_and_takes_them():
    with pytest.raises(
        DataError, match=r"a table of 3 columns without their names: name them in frames.names"
    ):
        read("1 2 3\n4 5 6\n")
    assert read("1 2 3\n4 5 6\n", ["id", "x", "z"])[0].load()["z"].tolist() == [3, 6]
    with pytest.raises(DataError, match=r"frames.names has 2 names for 3 columns"):
        read("1 2 3\n", ["id", "x"])


@pytest.mark.parametrize("row", ["0.5,3,0.1", "0.5,3,0.1,0.2,0.3", "0.5,3,0.1,wide", "nan,3,0.1,0.2"])
def test_a_row_with_a_fault_is_refused(row):
    with pytest.raises(DataError, match=r"no row of 4 numbers|has no time"):
        read("time,id,x,z\n0.5,1,0.1,0.2\n" + row + "\n")


def test_prose_is_no_table():
    assert table.layout_of(Source(io.BytesIO(b"Year 2020, said 3 people\nand 4 others\n"))) is None
