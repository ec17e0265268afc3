# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading dumps of both forms, and refusing what is wrong with them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bedchain.errors import UserError
from bedchain.trajectory.dumps import frame_of, read_dump
from made.synthetic_bed import COLUMNS, write_binary_dump, write_text_dump

BOX = [(0, 0.09), (-0.001, 0.001), (0, 0.45)]
BOUNDS = {"x": 0.09, "z": 0.45}
# the text form has six significant digits
TEXT_PRECISION = 5e-6
IDS = np.arange(1, 8)


@pytest.fixture
def table():
    rng = np.random.default_rng(5)
    values = np.column_stack([IDS, rng.uniform(0, 0.09, 7), rng.uniform(0, 0.45, 7), rng.normal(size=(7, 2))])
    return rng.permutation(values)


def frame(path, ids=IDS):
    return frame_of(read_dump(path, COLUMNS), COLUMNS, ids, BOUNDS)


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_binary_dump_comes_back_exactly(tmp_path, table, ranks):
    write_binary_dump(tmp_path / "a.bin", 1250, table, BOX, ranks)
    dump = read_dump(tmp_path / "a.bin", COLUMNS)
    assert dump.step == 1250
    np.testing.assert_array_equal(dump.box, BOX)
    np.testing.assert_array_equal(dump.values, table)


def test_a_rank_without_particles_is_no_fault(tmp_path, table):
    write_binary_dump(tmp_path / "a.bin", 0, table, BOX, ranks=9)
    assert read_dump(tmp_path / "a.bin", COLUMNS).values.shape == (7, 5)


def test_binary_and_text_of_one_frame_agree(tmp_path, table):
    write_binary_dump(tmp_path / "a.bin", 1250, table, BOX)
    write_text_dump(tmp_path / "a.txt", 1250, table, BOX)
    binary, text = read_dump(tmp_path / "a.bin", COLUMNS), read_dump(tmp_path / "a.txt", COLUMNS)
    assert binary.step == text.step
    np.testing.assert_array_equal(binary.box, text.box)
    np.testing.assert_allclose(text.values, binary.values, rtol=TEXT_PRECISION)


def test_frame_is_sorted_by_id(tmp_path, table):
    write_binary_dump(tmp_path / "a.bin", 0, table, BOX)
    np.testing.assert_array_equal(frame(tmp_path / "a.bin"), table[np.argsort(table[:, 0])].T)


@pytest.mark.parametrize("form", ["bin", "txt"])
@pytest.mark.parametrize("kept", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_cut_off_file_is_refused_wherever_it_is_cut(tmp_path, table, form, kept):
    path = tmp_path / f"a.{form}"
    (write_binary_dump if form == "bin" else write_text_dump)(path, 0, table, BOX)
    content = path.read_bytes()
    path.write_bytes(content[: int(kept * len(content))])
    with pytest.raises(UserError, match=f"{path}.*cut off"):
        read_dump(path, COLUMNS)


def test_text_that_lost_only_its_last_digits_is_refused(tmp_path, table):
    write_text_dump(tmp_path / "a.txt", 0, table, BOX)
    content = (tmp_path / "a.txt").read_bytes()
    (tmp_path / "a.txt").write_bytes(content[:-4])
    with pytest.raises(UserError, match="cut off"):
        read_dump(tmp_path / "a.txt", COLUMNS)


@pytest.mark.parametrize("value", [b"0.1x", b"0.1 0.2", b""])
def test_text_that_is_no_table_of_numbers_is_refused(tmp_path, table, value):
    write_text_dump(tmp_path / "a.txt", 0, table, BOX)
    content = (tmp_path / "a.txt").read_bytes().split(b"\n")
    words = content[12].split()
    content[12] = b" ".join([*words[:2], value, *words[3:]])
    (tmp_path / "a.txt").write_bytes(b"\n".join(content))
    with pytest.raises(UserError, match="no table of numbers"):
        read_dump(tmp_path / "a.txt", COLUMNS)


def test_bytes_after_the_last_particle_are_refused(tmp_path, table):
    write_binary_dump(tmp_path / "a.bin", 0, table, BOX)
    with (tmp_path / "a.bin").open("ab") as stream:
        stream.write(b"12345678")
    with pytest.raises(UserError, match="8 bytes after its last particle"):
        read_dump(tmp_path / "a.bin", COLUMNS)


def test_other_columns_are_refused(tmp_path, table):
    write_binary_dump(tmp_path / "a.bin", 0, table[:, :4], BOX)
    with pytest.raises(UserError, match=r"4 columns, 5 expected \(id x z vx vz\)"):
        read_dump(tmp_path / "a.bin", COLUMNS)
    write_text_dump(tmp_path / "a.txt", 0, table, BOX)
    with pytest.raises(UserError, match="columns id x z vx vz"):
        read_dump(tmp_path / "a.txt", ["id", "x", "y", "z"])


def test_something_else_than_a_dump_is_refused(tmp_path):
    (tmp_path / "a.bin").write_bytes(b"\x01" * 500)
    with pytest.raises(UserError, match="no LIGGGHTS dump"):
        read_dump(tmp_path / "a.bin", COLUMNS)
    with pytest.raises(UserError, match="cannot be read"):
        read_dump(tmp_path / "absent.bin", COLUMNS)


@pytest.mark.parametrize(
    ("row", "column", "value", "message"),
    [
        (2, 0, 4, "doubled: id 4; missing: id 3"),
        (2, 0, 99, "missing: id 3; unknown: id 99"),
        (4, 1, np.nan, "x of particle 5 is nan"),
        (4, 3, np.inf, "vx of particle 5 is inf"),
        (
            6,
            1,
            0.0903,
            r"1 particles are outside the bed, 0 to 0.09 m in x \(id 7; the farthest by 0.0003 m\)",
        ),
        (0, 2, -0.01, r"outside the bed, 0 to 0.45 m in z \(id 1; the farthest by 0.01 m\)"),
    ],
)
def test_bad_frame_is_refused(tmp_path, table, row, column, value, message):
    bad = table[np.argsort(table[:, 0])]
    bad[row, column] = value
    write_binary_dump(tmp_path / "a.bin", 0, bad, BOX)
    with pytest.raises(UserError, match=message):
        frame(tmp_path / "a.bin")


def test_doubled_id_is_refused_in_the_first_frame_too(tmp_path, table):
    table[table[:, 0] == 3, 0] = 4
    write_binary_dump(tmp_path / "a.bin", 0, table, BOX)
    with pytest.raises(UserError, match="doubled: id 4"):
        frame(tmp_path / "a.bin", ids=None)


def test_a_particle_exactly_on_the_wall_is_inside(tmp_path, table):
    table[0, 1], table[1, 2] = 0.09, 0.0
    write_binary_dump(tmp_path / "a.bin", 0, table, BOX)
    assert frame(tmp_path / "a.bin").shape == (5, 7)


@st.composite
def tables(draw):
    """Particles with any finite numbers that the bed allows, in any order of ids."""
    number = draw(st.integers(0, 6))
    ids = draw(st.permutations(range(1, number + 1)))
    inside = [st.floats(0, upper, allow_subnormal=False) for upper in (0.08, 0.44)]
    speed = st.floats(-1e6, 1e6, allow_subnormal=False)
    rows = [[float(i), *(draw(kind) for kind in (*inside, speed, speed))] for i in ids]
    return np.array(rows).reshape(number, 5)


@given(tables(), st.integers(0, 2**62), st.integers(1, 4))
def test_what_is_written_is_read(tmp_path, table, step, ranks):
    write_binary_dump(tmp_path / "a.bin", step, table, BOX, ranks)
    binary = read_dump(tmp_path / "a.bin", COLUMNS)
    assert binary.step == step and (binary.values == table).all() and (binary.box == BOX).all()
    write_text_dump(tmp_path / "a.txt", step, table, BOX)
    text = read_dump(tmp_path / "a.txt", COLUMNS)
    assert text.step == step and text.values == pytest.approx(table, rel=TEXT_PRECISION)


@settings(max_examples=200)
@given(st.sampled_from(["bin", "txt"]), st.data())
def test_a_spoilt_dump_is_refused_or_is_another_frame(tmp_path, form, data):
    rows = np.column_stack([IDS, np.linspace(0, 0.09, 7), np.linspace(0, 0.4, 7), IDS, -IDS])
    path = tmp_path / f"a.{form}"
    (write_binary_dump if form == "bin" else write_text_dump)(path, 1250, rows, BOX)
    content = bytearray(path.read_bytes())
    cut = data.draw(st.booleans())
    at = data.draw(st.integers(0, len(content) - 1))
    if cut:
        del content[at:]
    else:
        content[at] ^= data.draw(st.integers(1, 255))
    path.write_bytes(content)
    try:
        values = frame(path)
    except UserError:
        return
    # a byte of a number may make another number, and nothing else: a file that is cut off is never taken
    assert not cut and values.shape == (5, 7) and (values[0] == IDS).all() and np.isfinite(values).all()
