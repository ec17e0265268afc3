# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that the program reads, in many damaged forms: each must be read or refused by a `UserError`."""

import lzma
import shutil
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from resource import RLIMIT_AS, getrlimit, setrlimit
from signal import ITIMER_REAL, SIGALRM, setitimer, signal

import numpy as np

from bedchain.case.load import load_case
from bedchain.case.presets import read_presets
from bedchain.errors import UserError
from bedchain.trajectory.dumps import frame_of, read_dump
from bedchain.trajectory.packed_positions import FILTERS, read_levels, write_levels
from made import ROOT
from made.case_text import CASE
from made.mutations import mutated
from made.synthetic_bed import COLUMNS, dump_table, rolling_bed, write_binary_dump, write_text_dump

WIDTH, HEIGHT, NUMBER = 0.08, 0.20, 30
ROOM_BYTES = 700_000_000  # of addresses beyond those in use: a number in a header that is believed needs more
LONGEST_S = 10.0  # of one file

Change = Callable[[bytes, Random], bytes]


@dataclass(frozen=True)
class Target:
    """A file and its reader.

    Attributes
    ----------
    file : str
        Name.
    make : callable
        Writes the file, in good order.
    read : callable
        Reads it; the path is absolute.
    change : callable
        Another content with damage; files that are packed are damaged inside, too.
    """

    file: str
    make: Callable[[Path], object]
    read: Callable[[Path], object]
    change: Change = mutated


def try_damaged(target: Target, name: str, times: int, folder: Path) -> None:
    """Read a target so many times, each with other damage; the first that is neither read nor refused fails.

    Parameters
    ----------
    target : Target
    name : str
        Of the target, which with a number stands for one damage: the seed.
    times : int
    folder : Path
        Gets the file.
    """
    file = folder / target.file
    target.make(file)
    content = file.read_bytes()
    target.read(file)
    with limited_memory():
        for number in range(times):
            file.write_bytes(target.change(content, Random(f"{name} {number}")))
            try:
                with limited_time():
                    target.read(file)
            except UserError:
                continue
            except BaseException as error:
                kept = shutil.copy(file, folder.parent / f"damaged_{number}_{target.file}")
                where = "".join(traceback.format_tb(error.__traceback__)[-3:])
                raise AssertionError(f"{name} {number}, kept in {kept}: {error!r}\n{where}") from None


@contextmanager
def limited_memory() -> Iterator[None]:
    """No allocation from a number of a file: it ends in a MemoryError, which is no `UserError`."""
    before, hard = getrlimit(RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    setrlimit(RLIMIT_AS, (pages * 4096 + ROOM_BYTES, hard))
    try:
        yield
    finally:
        setrlimit(RLIMIT_AS, (before, hard))


@contextmanager
def limited_time() -> Iterator[None]:
    """No reading for ever."""

    def late(*_: object) -> None:
        raise TimeoutError(f"longer than {LONGEST_S:g} s")

    before = signal(SIGALRM, late)
    setitimer(ITIMER_REAL, LONGEST_S)
    try:
        yield
    finally:
        setitimer(ITIMER_REAL, 0)
        signal(SIGALRM, before)


def packed(content: bytes, random: Random) -> bytes:
    """An xz file with damage inside it or outside."""
    if random.random() < 0.3:
        return mutated(content, random)
    return lzma.compress(mutated(lzma.decompress(content), random), filters=FILTERS)


def write_dump(form: Callable) -> Callable[[Path], None]:
    """Maker of a dump of a small bed."""

    def write(file: Path) -> None:
        frame = rolling_bed(NUMBER, WIDTH, HEIGHT, np.array([0.0, 0.025]))[1]
        table = dump_table(frame, np.random.default_rng(1))
        form(file, 1250, table, [(0, WIDTH), (-0.001, 0.001), (0, HEIGHT)])

    return write


def read_frame(file: Path) -> np.ndarray:
    """A dump and all checks of its frame."""
    return frame_of(read_dump(file, COLUMNS), COLUMNS, None, {"x": WIDTH, "z": HEIGHT})


def write_packed(file: Path) -> None:
    """Compressed positions of five frames."""
    rng = np.random.default_rng(1)
    write_levels([rng.integers(0, 300, (2, NUMBER)).astype(np.uint16) for _ in range(5)], file)


def read_packed(file: Path) -> list[np.ndarray]:
    """Compressed positions of five frames."""
    return list(read_levels(file, 5, NUMBER))


TARGETS = {
    "case": Target("case.yaml", lambda file: file.write_text(CASE, encoding="utf-8"), load_case),
    "presets": Target(
        "presets.yaml", lambda file: shutil.copyfile(ROOT / "cases/presets.yaml", file), read_presets
    ),
    "binary dump": Target("frame.bin", write_dump(write_binary_dump), read_frame),
    "text dump": Target("frame.txt", write_dump(write_text_dump), read_frame),
    "packed positions": Target("positions.xz", write_packed, read_packed, packed),
}
