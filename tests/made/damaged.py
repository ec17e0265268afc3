# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that the program reads, in many damaged forms: each must be read or refused by a `UserError`."""

import json
import lzma
import shutil
import traceback
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from random import Random
from resource import RLIMIT_AS, getrlimit, setrlimit
from signal import ITIMER_REAL, SIGALRM, setitimer, signal
from typing import Any

import numpy as np

from bedchain.case.load import load_case
from bedchain.case.presets import read_presets
from bedchain.case.schema import load_schema
from bedchain.chains import registry
from bedchain.comparison.claims import read_claims
from bedchain.dem.gas_field import archived_gas
from bedchain.dem.series import read_series
from bedchain.errors import UserError
from bedchain.files import write_arrays
from bedchain.studies.validation import read_points
from bedchain.trajectory.archive import check_archive, check_files
from bedchain.trajectory.cell_store import write_cells
from bedchain.trajectory.dumps import frame_of, read_dump
from bedchain.trajectory.forms.files import FormSettings, frames_of
from bedchain.trajectory.frame_files import files_of
from bedchain.trajectory.frames import Window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.packed_positions import FILTERS, read_levels, write_levels
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles
from bedchain.trajectory.stored_dumps import write_trajectory
from made import ROOT
from made.case_text import CASE
from made.forms import COLUMNS as FORM_COLUMNS
from made.forms import moving, write_form
from made.frames import stirred
from made.mutations import mutated
from made.synthetic_bed import (
    COLUMNS,
    dump_table,
    rolling_bed,
    write_binary_dump,
    write_run,
    write_series,
    write_text_dump,
)

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


def try_damaged(target: Target, name: str, times: int, folder: Path, first: int = 0) -> None:
    """Read a target so many times, each with other damage; the first that is neither read nor refused fails.

    Parameters
    ----------
    target : Target
    name : str
        Of the target, which with a number stands for one damage: the seed.
    times : int
    folder : Path
        Gets the file.
    first : int
        Number of the first damage, so that a stopped run can go on.
    """
    file = folder / target.file
    target.make(file)
    content = file.read_bytes()
    target.read(file)
    with limited_memory():
        for number in range(first, first + times):
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


def restructured(content: bytes, random: Random) -> bytes:
    """A json file with other bytes, or with another value, kind or name at some place of it."""
    if random.random() < 0.4:
        return mutated(content, random)
    data = json.loads(content)
    for _ in range(random.randint(1, 2)):
        place: Any = data
        while True:
            key = random.choice(list(place) if isinstance(place, dict) else range(len(place)))
            if not (isinstance(place[key], dict | list) and place[key]) or random.random() < 0.3:
                break
            place = place[key]
        if random.random() < 0.3:
            del place[key]
        else:
            place[key] = random.choice(ODD_VALUES)
        if not data:
            break
    return json.dumps(data).encode()


def rezipped(content: bytes, random: Random) -> bytes:
    """An .npz with damage inside an array's file, whose sums are right, or outside."""
    if random.random() < 0.3:
        return mutated(content, random)
    with zipfile.ZipFile(BytesIO(content)) as archive:
        arrays = {name: archive.read(name) for name in archive.namelist()}
    name = random.choice(list(arrays))
    action = random.random()
    if action < 0.1:
        del arrays[name]
    elif action < 0.2:
        arrays[name] = random.choice(list(arrays.values()))
    else:
        arrays[name] = mutated(arrays[name], random)
    with zipfile.ZipFile(stream := BytesIO(), "w") as archive:
        for name, values in arrays.items():
            archive.writestr(name, values)
    return stream.getvalue()


def write_bed(folder: Path) -> BedFiles:
    """A small bed as its stages leave it, in a folder."""
    times = np.round(np.arange(5) * 0.025, 6)
    dem = write_run(folder, rolling_bed(NUMBER, WIDTH, HEIGHT, times), times, WIDTH, HEIGHT, segment=0.05)
    files = BedFiles(*(folder / name for name in ("trajectory.npy", "trajectory.json", "cells.npz")))
    write_trajectory(dem, files.trajectory, files.metadata, WIDTH, HEIGHT, progress=False)
    write_cells(np.load(files.trajectory), times, Grid(WIDTH, HEIGHT, 4, 5), files.cells)
    return files


def read_run(dem: Path) -> None:
    """All frames of a run, by its manifest."""
    trajectory, metadata = dem.with_name("again.npy"), dem.with_name("again.json")
    write_trajectory(dem, trajectory, metadata, WIDTH, HEIGHT, progress=False)


def read_bed(file: Path) -> Any:
    """A window of a bed, with the cells, by any of its three files."""
    run = open_bed(
        BedFiles(*(file.with_name(name) for name in ("trajectory.npy", "trajectory.json", "cells.npz")))
    )
    return run.window(Window(0.025, 0.1))


def write_chain(file: Path) -> None:
    """A static chain of the small bed."""
    frames, grid = stirred(n_frames=20, n_particles=50)
    registry.save(registry.learn("static", frames, grid), file)


def read_chain(file: Path) -> Any:
    """A chain, and a step of it."""
    chain = registry.load(file)
    return chain.matrix @ np.ones(chain.matrix.shape[0])


def write_gas(file: Path) -> None:
    """Two times of an archived gas."""
    x, z = (axis.ravel() for axis in np.meshgrid([0.01, 0.03], [0.01, 0.03, 0.05]))
    write_arrays(file, {"times_s": np.array([0.0, 1.0]), "x_m": x, "z_m": z, "voidage": np.ones((2, 6))})


def write_bed_series(file: Path) -> None:
    """The series of a bed of ten rows."""
    write_series(file.parent, np.arange(10) * 0.01, 800.0, 0.05, NUMBER)


def copied(name: str) -> Callable[[Path], object]:
    """Maker that copies a file of the repository."""
    return lambda file: shutil.copyfile(ROOT / name, file)


def read_archive(file: Path) -> Any:
    """The provenance of an archive, beside a case, a part of its frames and its file list."""
    provenance = check_archive(file.parent, PAPER, SCHEMA)
    with suppress(UserError):  # of the other files, which are not there
        check_files(file.parent, provenance)
    return provenance


def write_imported(form: str) -> Callable[[Path], None]:
    """Maker of a file of another code's, of a form of `made.forms`."""

    def write(file: Path) -> None:
        first = files_of(write_form(form, file.parent / "of_form", moving(n_frames=1)), Path())[0]
        shutil.copyfile(first, file)

    return write


def read_imported(form: str) -> Callable[[Path], object]:
    """Reader of all frames of such a file."""
    settings = FormSettings(names=FORM_COLUMNS if form == "binary" else None)
    return lambda file: [frame.load() for frame in frames_of(file, settings)]


IMPORTED = ("many_text", "binary", "gz", "table", "npz")  # VTK's readers are in C++, beyond a UserError
ODD_VALUES = (None, True, 0, -1, 0.5, 1e308, 10**30, "", "x", "../x", [], {}, [1], {"a": 1}, "nan", "1")
SCHEMA = load_schema()
PAPER = load_case(ROOT / "cases/paper/case.yaml")
TARGETS = {
    "case": Target("case.yaml", lambda file: file.write_text(CASE, encoding="utf-8"), load_case),
    "presets": Target("presets.yaml", copied("cases/presets.yaml"), read_presets),
    "binary dump": Target("frame.bin", write_dump(write_binary_dump), read_frame),
    "text dump": Target("frame.txt", write_dump(write_text_dump), read_frame),
    "packed positions": Target("positions.xz", write_packed, read_packed, packed),
    "manifest": Target("dem.json", lambda file: write_bed(file.parent), read_run, restructured),
    "metadata": Target("trajectory.json", lambda file: write_bed(file.parent), read_bed, restructured),
    "trajectory": Target("trajectory.npy", lambda file: write_bed(file.parent), read_bed),
    "cells": Target("cells.npz", lambda file: write_bed(file.parent), read_bed, rezipped),
    "chain": Target("transitions_static.npz", write_chain, read_chain, rezipped),
    "archived gas": Target("gas.npz", write_gas, lambda file: archived_gas(file, "voidage", 0.5), rezipped),
    "series": Target("bed_series.csv", write_bed_series, read_series),
    "claims": Target("claims.csv", copied("cases/paper/claims.csv"), read_claims),
    "measured points": Target("measured.csv", copied("cases/mueller/measured.csv"), read_points),
    "archive": Target(
        "provenance.json", copied("cases/paper/reference/provenance.json"), read_archive, restructured
    ),
    **{
        f"imported {form}": Target(
            f"frame_100.{form}",
            write_imported(form),
            read_imported(form),
            rezipped if form == "npz" else mutated,
        )
        for form in IMPORTED
    },
}
