# SPDX-License-Identifier: GPL-3.0-or-later
"""Binary dumps of both kinds, many in one file, and every fault of a header or chunk named."""

import io
import struct

import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.lammps_binary import read_frames
from bedchain.trajectory.forms.raw import CutOffError
from bedchain.trajectory.forms.streams import Source
from made.forms import COLUMNS, binary_frame, moving

SERIES = moving(n_frames=2)
OLD, NEW = (binary_frame(SERIES, 0, magic) for magic in (b"", b"DUMPCUSTOM"))


def frames(content: bytes, names=COLUMNS):
    return list(read_frames(Source(io.BytesIO(content)), {}, names))


def test_many_frames_of_both_kinds_in_one_file():
    both = frames(OLD + binary_frame(SERIES, 1, b"DUMPATOM"))
    assert [frame.step for frame in both] == [0, 1000] and both[1].time == pytest.approx(0.01)
    assert both[1].load()["z"].tolist() == SERIES.positions[1, :, 2].tolist()


def test_columns_without_names_are_asked_for():
    with pytest.raises(DataError, match=r"holds 9 columns without their names: name them in frames.names"):
        frames(OLD, None)
    with pytest.raises(DataError, match=r"frames.names has 2"):
        frames(OLD, ["id", "x"])
    assert frames(NEW, None)[0].columns == frames(OLD)[0].columns


def changed(content: bytes, at: int, form: str, value) -> bytes:
    return content[:at] + struct.pack("<" + form, value) + content[at + struct.calcsize("<" + form) :]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (changed(OLD, 16, "i", 1), "a triclinic box"),
        (changed(OLD, 8, "q", -5), "this is no binary dump"),
        (changed(OLD, 0, "q", -5), "is no step"),
        (changed(OLD, 92, "i", 0), "this is no binary dump"),
        (changed(OLD, 44, "d", float("nan")), "bounds of its box"),
        (changed(OLD, 96, "i", -1), "chunks"),
        (changed(OLD, 100, "i", 91), "not whole rows of 9"),
        (changed(OLD, 8, "q", 21), "holds 20 particles, 21 announced"),
        (changed(NEW, 18, "i", 1 << 24), "another order of bytes"),
    ],
)
def test_a_header_with_a_fault_is_refused(content, message):
    with pytest.raises(DataError, match=message):
        frames(content)


@pytest.mark.parametrize("kept", [4, 50, 99, 102, 300, -1])
def test_a_cut_end_is_told_from_a_fault(kept):
    with pytest.raises(CutOffError, match="cut off"):
        frames(OLD[:kept])


def test_a_number_in_a_chunk_takes_no_memory():
    with pytest.raises(CutOffError, match="particles"):
        frames(changed(OLD, 100, "i", 2**31 - 1 - (2**31 - 1) % 9))
