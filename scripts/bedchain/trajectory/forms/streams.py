# SPDX-License-Identifier: GPL-3.0-or-later
"""Bytes of a user's file, unpacked on the way where it is compressed, read in blocks."""

import gzip
import importlib
import io
import lzma
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np

from bedchain.errors import DataError

MAGIC = {
    b"\x1f\x8b": "gz",
    b"\xfd7zXZ\x00": "xz",
    b"\x28\xb5\x2f\xfd": "zst",
    b"BZh": "bz2",
    b"PK\x03\x04": "zip",
}
BLOCK_BYTES = 4 * 2**20
PACKED_BYTES = 2**16  # of zstd at once: its content is unpacked as a whole
MOST_LINE_BYTES = 65_536


def compression(head: bytes) -> str | None:
    """Name of the compression that the first bytes of a file show; None for none."""
    return next((name for magic, name in MAGIC.items() if head.startswith(magic)), None)


@contextmanager
def opened(path: Path) -> Iterator[IO[bytes]]:
    """A file for reading only, through the right decompression.

    Raises
    ------
    DataError
        It cannot be read, its compressed content is damaged, or it needs a package that is not installed.
    """
    try:
        with path.open("rb") as file:
            packed = compression(file.read(8))
            file.seek(0)
            yield _unpacked(file, packed, path)
    except CUT_OFF as error:
        raise DataError(f"{path} is damaged or cut off in its compressed content ({error})") from error
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror or error})") from error


CUT_OFF = (EOFError, lzma.LZMAError, zlib.error, gzip.BadGzipFile)


def _unpacked(file: IO[bytes], packed: str | None, path: Path) -> IO[bytes]:
    if packed == "gz":
        return gzip.GzipFile(fileobj=file)  # type: ignore[return-value]
    if packed == "xz":
        return lzma.LZMAFile(file)
    if packed == "zst":
        try:
            decompressor = importlib.import_module("zstandard").ZstdDecompressor()
        except ImportError as error:
            raise DataError(
                f"{path} is compressed by zstd: unpack it (zstd -d), or pip install zstandard"
            ) from error
        return io.BufferedReader(_ZstdFile(file, decompressor), BLOCK_BYTES)
    return file


class _ZstdFile(io.RawIOBase):
    """Content of a zstd file; zstandard's own reader takes a file that is cut off for one that ends."""

    def __init__(self, file: IO[bytes], decompressor: Any) -> None:
        self._file, self._decompressor = file, decompressor
        self._frame = decompressor.decompressobj()
        self._fed = False  # whether the frame has had any bytes
        self._packed = self._content = b""

    def readable(self) -> bool:
        """Always."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Fill a buffer as far as there is content.

        Raises
        ------
        EOFError
            The file is cut off, or damaged.
        """
        while not self._content and self._next_block():
            pass
        size = min(len(buffer), len(self._content))
        buffer[:size], self._content = self._content[:size], self._content[size:]
        return size

    def _next_block(self) -> bool:
        """Unpack some more of the file; false at its end."""
        self._packed = self._packed or self._file.read(PACKED_BYTES)
        if not self._packed:
            if self._fed:
                raise EOFError("the file ended before its content")
            return False
        try:
            self._content = self._frame.decompress(self._packed)
        except Exception as error:  # zstandard's own, whose package may not be there to name it
            raise EOFError(str(error)) from error
        self._packed, self._fed = self._frame.unused_data, not self._frame.eof
        if self._frame.eof:
            self._frame = self._decompressor.decompressobj()
        return True


class Source:
    """A stream with a buffer of its own: lines, blocks of many lines, and exact numbers of bytes.

    Parameters
    ----------
    stream : binary file
    """

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self._buffer = b""
        self._at = 0  # read so far of the buffer: a copy of the rest for each line would take longest

    def _more(self) -> bytes:
        """The next block, empty at the end."""
        try:
            return self._stream.read(BLOCK_BYTES)
        except CUT_OFF as error:
            raise DataError(f"the compressed content is damaged or cut off ({error})") from error

    def line(self) -> bytes | None:
        """The next line with its end, None at the end; a last line may lack its end.

        Raises
        ------
        DataError
            It is longer than any line of a header.
        """
        while (end := self._buffer.find(b"\n", self._at)) < 0:
            self._buffer, self._at = self._buffer[self._at :], 0
            if len(self._buffer) > MOST_LINE_BYTES:
                raise DataError(f"a line is longer than {MOST_LINE_BYTES} bytes: this is no text of a dump")
            if not (block := self._more()):
                rest, self._buffer = self._buffer, b""
                return rest or None
            self._buffer += block
        line, self._at = self._buffer[self._at : end + 1], end + 1
        return line

    def lines(self, number: int, keep: bool = True) -> tuple[bytes, int]:
        """The next so many lines as one piece, and how many there are: fewer at the end.

        Parameters
        ----------
        number : int
        keep : bool
            Whether the bytes are wanted, or only passed over.
        """
        pieces: list[bytes] = []
        count = 0
        block = self._buffer[self._at :]
        while True:
            ends = block.count(b"\n")
            if count + ends >= number:
                at = _nth_end(block, number - count)
                self._buffer, self._at = block, at
                return (b"".join([*pieces, block[:at]]) if keep else b""), number
            count += ends
            if keep:
                pieces.append(block)
            if not (block := self._more()):
                self._buffer, self._at = b"", 0
                return b"".join(pieces), count

    def exactly(self, size: int) -> bytes:
        """The next bytes, fewer at the end of the file; memory is taken for what is there only."""
        pieces: list[bytes] = []
        left = size
        while left > 0 and not self.at_end():
            piece = self._buffer[self._at : self._at + left]
            self._at += len(piece)
            left -= len(piece)
            pieces.append(piece)
        return b"".join(pieces)

    def at_end(self) -> bool:
        """Whether nothing is left."""
        if self._at >= len(self._buffer):
            self._buffer, self._at = self._more(), 0
        return not self._buffer


def _nth_end(block: bytes, number: int) -> int:
    """Place behind the n-th line end of a block."""
    if number <= 0:
        return 0
    return int(np.flatnonzero(np.frombuffer(block, np.uint8) == ord("\n"))[number - 1]) + 1
