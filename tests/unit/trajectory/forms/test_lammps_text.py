# SPDX-License-Identifier: GPL-3.0-or-later
"""Text dumps in the ways that LIGGGHTS and LAMMPS write them, and every fault named."""

import io

import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.lammps_text import read_frames
from bedchain.trajectory.forms.raw import CutOffError
from bedchain.trajectory.forms.streams import Source

ITEMS = {
    "TIMESTEP": "ITEM: TIMESTEP\n40\n",
    "NUMBER": "ITEM: NUMBER OF ATOMS\n2\n",
    "BOX": "ITEM: BOX BOUNDS pp ff ff\n0 2\n0 1\n-1 1\n",
    "ATOMS": "ITEM: ATOMS id xs y z \n7 0.5 0.1 0.2 \n3 1 0.3 0.4 \n",
}


def frames(text: str, keep: bool = True):
    return list(read_frames(Source(io.BytesIO(text.encode())), {}, keep))


@pytest.mark.parametrize("order", [("TIMESTEP", "NUMBER", "BOX"), ("BOX", "NUMBER", "TIMESTEP")])
def test_items_come_in_any_order_with_units_and_time(order):
    text = "ITEM: UNITS\nsi\nITEM: TIME\n0.25\n" + "".join(ITEMS[name] for name in (*order, "ATOMS"))
    (frame,) = frames(text)
    assert (frame.step, frame.time, frame.number) == (40, 0.25, 2) and frame.periodic == (True, False, False)
    assert {name: column.tolist() for name, column in frame.load().items()} == {
        "id": [7, 3], "x": [1, 2], "y": [0.1, 0.3], "z": [0.2, 0.4],
    }  # fmt: skip


def test_headers_are_read_without_particles_and_empty_frames_have_none():
    empty = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\n" + ITEMS["BOX"] + "ITEM: ATOMS id xs y z\n"
    two = frames(empty + "\n" + "".join(ITEMS.values()), keep=False)
    assert [(frame.step, frame.number) for frame in two] == [(0, 0), (40, 2)]
    assert frames(empty)[0].load()["id"].size == 0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ITEM: BOX BOUNDS pp ff ff", "ITEM: BOX BOUNDS xy xz yz pp ff ff", "a triclinic box"),
        ("0 2\n", "0 2 0.1\n", "a triclinic box"),
        ("-1 1\n", "-1 wide\n", "BOX BOUNDS has the values"),
        ("ITEM: NUMBER OF ATOMS\n2", "ITEM: NUMBER OF ATOMS\n-2", "NUMBER OF ATOMS has the value '-2'"),
        ("ITEM: NUMBER OF ATOMS\n2\n", "", "without ITEM: NUMBER OF ATOMS"),
        ("ITEM: TIMESTEP", "ITEM: ENTRIES c_1", "no item of a dump of particles"),
        ("40\n", "40\nhello\n", "'hello' stands where an ITEM: line"),
        (" id xs y z \n", "\n", "names no columns"),
    ],
)
def test_a_header_with_a_fault_is_refused(old, new, message):
    text = "".join(ITEMS.values())
    assert old in text
    with pytest.raises(DataError, match=message):
        frames(text.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new"),
    [("0.3 0.4", "0.3"), ("0.3 0.4", "0.3 0.4 0.5"), ("0.3", "0x3"), ("3 1 0.3 0.4 \n", "ITEM: X\n")],
)
def test_a_line_with_a_fault_is_refused(old, new):
    text = "".join(ITEMS.values())
    (frame,) = frames(text.replace(old, new))
    with pytest.raises(DataError, match="a line is no row of 4 numbers"):
        frame.load()


def test_columns_that_nothing_is_known_of_are_refused():
    (frame,) = frames("".join(ITEMS.values()).replace(" id xs y z ", " c_1 c_2 c_3 c_4 "))
    with pytest.raises(DataError, match="none of its columns is an id, a place or a velocity"):
        frame.load()


@pytest.mark.parametrize("kept", [5, 20, 60, 95, -1])
def test_a_cut_end_is_told_from_a_fault(kept):
    with pytest.raises(CutOffError, match="cut off"):
        frames("".join(ITEMS.values())[:kept])


def test_a_number_in_a_header_takes_no_memory():
    with pytest.raises(CutOffError, match="2 of 2000000000 particles"):
        frames("".join(ITEMS.values()).replace("ATOMS\n2\n", "ATOMS\n2000000000\n"))
