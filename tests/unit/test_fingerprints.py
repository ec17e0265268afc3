# SPDX-License-Identifier: GPL-3.0-or-later
"""Files known by size and hash: each damage is seen, named, and put aside so that the file is made again."""

import os

import numpy as np
import pytest

from bedchain import fingerprints
from bedchain.errors import DataError, UserError
from bedchain.fingerprints import (
    check_fingerprint,
    check_noted,
    fingerprint_of,
    note_fingerprints,
    note_of,
    unreadable,
)


@pytest.fixture
def table(tmp_path):
    file = tmp_path / "metrics.csv"
    file.write_text("quantity,value\na,1\nb,2\n")
    note_fingerprints([file])
    return file


def test_a_file_as_it_was_written_passes(table):
    check_noted([table, table.with_name("never_made.csv")])
    assert note_of(table).name == "metrics.csv.json"


@pytest.mark.parametrize(
    ("content", "wrong"),
    [
        ("quantity,value\na,1\n", "is cut off: 19 of 23 bytes"),  # at the end of a line
        ("", "is cut off: 0 of 23 bytes"),
        ("\0" * 23, "was changed after it was written"),
        ("quantity,value\na,1\nb,2\nc,3\n", "was changed after it was written"),
    ],
)
def test_a_damaged_file_is_named_and_put_aside(table, content, wrong):
    table.write_text(content)
    with pytest.raises(UserError, match=rf"metrics.csv {wrong}.*metrics.csv.damaged now: give"):
        check_noted([table])
    assert not table.exists() and table.with_name("metrics.csv.damaged").read_text() == content


def test_a_file_under_the_name_of_another_is_seen(tmp_path):
    for name in ("static", "dynamic"):
        np.savez(tmp_path / f"chain_{name}.npz", name=np.array(f"{name:8}"))
    note_fingerprints(tmp_path.glob("*.npz"))
    os.replace(tmp_path / "chain_dynamic.npz", tmp_path / "chain_static.npz")
    with pytest.raises(UserError, match="chain_static.npz was changed"):
        check_noted([tmp_path / "chain_static.npz"])


def test_a_file_that_is_missing_or_a_folder_is_named(table):
    table.unlink()
    with pytest.raises(UserError, match="metrics.csv cannot be read .*; give the same command again"):
        check_noted([table])
    table.mkdir()
    with pytest.raises(UserError, match="metrics.csv .*move away what stands in its place"):
        check_noted([table])


@pytest.mark.parametrize("note", ["", "[]", "{}", '{"bytes": 1}'])
def test_a_note_that_is_damaged_itself_says_nothing(table, note):
    note_of(table).write_text(note)
    check_noted([table])


def test_a_large_file_is_known_by_blocks_of_it(tmp_path, monkeypatch):
    monkeypatch.setattr(fingerprints, "BLOCK_BYTES", 10)
    file = tmp_path / "trajectory.npy"
    content = bytes(range(200)) * 2
    file.write_bytes(content)
    fingerprint = fingerprint_of(file, 100)
    check_fingerprint(file, fingerprint, most_bytes=100)
    zeros = content[:100] + b"\0" * 100 + content[200:]
    for damaged in (b"\0" * 400, content[:-1] + b"x", b"x" + content[1:], zeros):
        file.write_bytes(damaged)
        with pytest.raises(DataError, match="trajectory.npy was changed"):
            check_fingerprint(file, fingerprint, most_bytes=100)


def test_what_cannot_be_read_is_found_by_its_kind(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.arange(100))
    np.save(tmp_path / "a.npy", np.arange(100))
    (tmp_path / "a.json").write_text('{"a": 1}')
    (tmp_path / "a.csv").write_text("alpha,b\n1,2\n")
    files = sorted(tmp_path.iterdir())
    assert unreadable(files) is None
    for file in files:
        whole = file.read_bytes()
        end = 20 if len(whole) > 100 else 1
        for damaged in (whole[: len(whole) // 2], b"", b"\0" * len(whole), whole[:-end]):
            file.write_bytes(damaged)
            assert unreadable(files)[0] == file
        file.unlink()
        assert unreadable(files)[0] == file
        os.mkfifo(file)
        assert "special file" in unreadable(files)[1]
        file.unlink()
        file.write_bytes(whole)
