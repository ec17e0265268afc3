# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines, pieces and bytes of a stream across its blocks, and files that are compressed, well or badly."""

import gzip
import io
import lzma

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms import streams
from bedchain.trajectory.forms.streams import Source, compression, opened

LINES = [f"line {number}\n".encode() for number in range(50)]


@pytest.fixture(params=[1, 7, 64, 10_000])
def source(request, monkeypatch):
    monkeypatch.setattr(streams, "BLOCK_BYTES", request.param)
    return Source(io.BytesIO(b"".join(LINES) + b"end"))


def test_lines_and_pieces_come_in_order_whatever_the_block(source):
    assert [source.line(), source.line()] == LINES[:2]
    assert source.lines(30) == (b"".join(LINES[2:32]), 30)
    assert source.lines(0) == (b"", 0)
    assert source.lines(5, keep=False) == (b"", 5)
    assert source.exactly(4) == b"line" and source.line() == b" 37\n"
    piece, count = source.lines(100)
    assert count == 12 and piece == b"".join(LINES[38:]) + b"end"
    assert source.at_end() and source.line() is None and source.exactly(3) == b""


def test_an_endless_line_is_refused():
    with pytest.raises(DataError, match="a line is longer than 65536 bytes"):
        Source(io.BytesIO(b"x" * 9 * 2**20)).line()


def test_compressed_files_are_unpacked_and_damage_is_named(tmp_path):
    for suffix, pack in (("gz", gzip.compress), ("xz", lzma.compress)):
        file = tmp_path / f"a.{suffix}"
        file.write_bytes(pack(b"".join(LINES)))
        assert compression(file.read_bytes()) == suffix
        with opened(file) as stream:
            assert Source(stream).lines(50)[0] == b"".join(LINES)
        file.write_bytes(file.read_bytes()[:-20])
        with pytest.raises(DataError, match="damaged or cut off"), opened(file) as stream:
            Source(stream).lines(50)


def test_zstd_is_unpacked_over_all_its_frames_and_a_cut_is_noticed(tmp_path):
    zstandard = pytest.importorskip("zstandard")
    content = bytes(np.random.default_rng(1).integers(65, 90, 300_000, np.uint8))
    packed = zstandard.ZstdCompressor(write_checksum=True).compress(content)  # as zstd does
    (file := tmp_path / "a.zst").write_bytes(packed + packed)
    with opened(file) as stream:
        assert stream.read() == content * 2
    for wrong in (packed[:-3], packed[:8], packed + packed[:50], packed[:40] + b"x" * 40 + packed[80:]):
        file.write_bytes(wrong)
        with pytest.raises(DataError, match="damaged or cut off"), opened(file) as stream:
            stream.read()


def test_zstd_without_its_package_says_the_way_out(tmp_path, monkeypatch):
    (tmp_path / "a.zst").write_bytes(b"\x28\xb5\x2f\xfd....")
    monkeypatch.setitem(__import__("sys").modules, "zstandard", None)
    with (
        pytest.raises(DataError, match=r"a.zst is compressed by zstd: unpack it"),
        opened(tmp_path / "a.zst"),
    ):
        pass
