# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of reading frames of other programs into the store, beside the parsers alone.

usage: python scripts/benchmark_import.py --frames 400      (1.5 GB of text; each form is deleted after it)
       python scripts/benchmark_import.py --frames 3000 --forms many_text      (a single file of 11 GB)
"""

import argparse
import io
import json
import logging
import os
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.files import write_csv
from bedchain.meter import peak_memory_mb
from bedchain.studies.cost.benchmark_table import machine
from bedchain.trajectory.forms.files import FormSettings, frames_of
from bedchain.trajectory.imported import Targets
from import_frames import Box, Tables, import_frames

WIDTH_M, HEIGHT_M, INTERVAL_STEPS, STEP_S = 0.27, 1.05, 1250, 2e-5
COLUMNS = ("id", "x", "y", "z", "vx", "vz")
DISTINCT = 4  # frames that are made; the files repeat them, with a step of their own
SECTION = {
    "files": "*", "step_s": STEP_S, "length_unit_m": 1.0, "time_unit_s": 1.0, "across": "x", "up": "z",
    "keep_depth": False, "without_ids": "refuse", "origin_m": [0.0, 0.0, 0.0], "names": list(COLUMNS),
}  # fmt: skip
FIELDS = ("form", "frames", "files_mb", "wall_s", "cpu_s", "mb_s", "mb_cpu_s", "parser_mb_s", "peak_rss_mb")


def tables(particles: int) -> list[np.ndarray]:
    """Made-up frames, (n_particles, n_columns), particles in an order of their own as dumps have it."""
    rng = np.random.default_rng(15)
    ids = rng.permutation(particles) + 1.0
    start = np.column_stack((WIDTH_M * rng.random(particles), 0.4 * HEIGHT_M * rng.random(particles)))
    speed = rng.normal(0, 0.1, start.shape)
    frames = []
    for frame in range(DISTINCT):
        x, z = np.abs(start + speed * frame * 1e-3).T
        places = (np.minimum(x, WIDTH_M), np.full(particles, 5e-4), z)
        frames.append(np.column_stack((ids, *places, *speed.T)))
    return frames


def text_body(table: np.ndarray) -> bytes:
    """Rows of a text dump: six digits, and a blank at the end of a line."""
    return "".join(
        f"{row[0]:.0f} {' '.join(f'{value:.6g}' for value in row[1:])} \n" for row in table
    ).encode()


def text_head(step: int, particles: int) -> bytes:
    """Header of a text dump."""
    bounds = f"0 {WIDTH_M}\n0 0.001\n0 {HEIGHT_M}\n"
    head = f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{particles}\nITEM: BOX BOUNDS ff ff ff\n{bounds}"
    return (head + f"ITEM: ATOMS {' '.join(COLUMNS)} \n").encode()


def binary_head(step: int, particles: int) -> bytes:
    """Header of a binary dump of one rank."""
    box = (0.0, WIDTH_M, 0.0, 0.001, 0.0, HEIGHT_M)
    head = struct.pack("<qqi6i6dii", step, particles, 0, *[1] * 6, *box, len(COLUMNS), 1)
    return head + struct.pack("<i", particles * len(COLUMNS))


def vtk_body(table: np.ndarray, ascii_form: bool) -> bytes:
    """A legacy VTK file of version 4.2, as LIGGGHTS writes it."""
    number = len(table)

    def block(values: np.ndarray, kind: str) -> bytes:
        if ascii_form:
            return " ".join(f"{value:.6g}" for value in values.ravel()).encode() + b"\n"
        return values.astype(kind).tobytes() + b"\n"

    velocity = np.insert(table[:, 4:], 1, 0.0, axis=1)
    vertices = np.column_stack((np.ones(number), np.arange(number)))
    form = "ASCII" if ascii_form else "BINARY"
    return b"".join((
        f"# vtk DataFile Version 4.2\nmade up\n{form}\nDATASET POLYDATA\nPOINTS {number} float\n".encode(),
        block(table[:, 1:4], ">f4"), f"VERTICES {number} {2 * number}\n".encode(), block(vertices, ">i4"),
        f"POINT_DATA {number}\nFIELD FieldData 2\nid 1 {number} int\n".encode(), block(table[:, 0], ">i4"),
        f"v 3 {number} double\n".encode(), block(velocity, ">f8"),
    ))  # fmt: skip


def contents(form: str, particles: int, frames: int) -> Iterator[bytes]:
    """Content of each frame of a form."""
    made = tables(particles)
    vtk = form.startswith("vtk")
    make: Callable[[np.ndarray], bytes] = (
        (lambda table: vtk_body(table, form == "vtk_ascii")) if vtk
        else np.ndarray.tobytes if form == "binary" else text_body
    )  # fmt: skip
    bodies = [make(table) for table in made]
    for frame in range(frames):
        step = frame * INTERVAL_STEPS
        head = b"" if vtk else (binary_head if form == "binary" else text_head)(step, particles)
        yield head + bodies[frame % DISTINCT]


FORMS = ("text", "many_text", "binary", "vtk_ascii", "vtk_binary")


def write_files(form: str, folder: Path, particles: int, frames: int) -> None:
    """All frames of a form, in one file or a file each."""
    folder.mkdir()
    if form == "many_text":
        with (folder / "all.dump").open("wb") as stream:
            stream.writelines(contents(form, particles, frames))
    else:
        for frame, content in enumerate(contents(form, particles, frames)):
            (folder / f"frame_{frame * INTERVAL_STEPS}.dump").write_bytes(content)
    os.sync()  # or writing them to disk is timed as reading them


def measure(form: str, folder: Path) -> dict[str, float]:
    """Import the files of a folder in this process, which is fresh, then read some by the parser alone.

    ``mb_s`` is by the clock, ``mb_cpu_s`` by the processor time of all threads: what one core would do.
    """
    logging.getLogger("bedchain").setLevel(logging.ERROR)  # the motion is made up, which it would warn of
    outputs = folder.parent / "out"
    outputs.mkdir(exist_ok=True)
    began, worked = time.perf_counter(), sum(os.times()[:4])
    import_frames(
        SECTION, folder, Box(WIDTH_M, HEIGHT_M, "refuse"),
        Targets(*(outputs / name for name in ("trajectory.npy", "trajectory.json", "particles.npz"))),
        Tables(outputs / "bed_series.csv", outputs / "motion.csv"), progress=False,
    )  # fmt: skip
    wall, cpu = time.perf_counter() - began, sum(os.times()[:4]) - worked
    size_mb = sum(file.stat().st_size for file in folder.iterdir()) / 1e6
    return {
        "files_mb": size_mb, "wall_s": wall, "cpu_s": cpu, "mb_s": size_mb / wall, "mb_cpu_s": size_mb / cpu,
        "peak_rss_mb": peak_memory_mb(), "parser_mb_s": parser_speed(form, folder),
    }  # fmt: skip


def parser_speed(form: str, folder: Path) -> float:
    """Speed of the bare parser on the first frame, warm, the best of three [MB a second of processor time].

    That is pandas for text, the module of the form for the others: no checks, no sorting, no store.
    """
    file = min(folder.iterdir(), key=lambda path: len(path.name))
    times: list[float] = []
    for _ in range(3):
        if form in ("text", "many_text"):
            with file.open("rb") as stream:
                body = b"".join(line for _, line in zip(range(90_009), stream, strict=False))
            body = body.split(b"ITEM: ATOMS", 1)[1].split(b"\n", 1)[1].split(b"ITEM:")[0]
            began, size = time.process_time(), len(body)
            pd.read_csv(io.BytesIO(body), sep=r"\s+", header=None, dtype=np.float64)
        else:
            began, size = time.process_time(), file.stat().st_size
            next(frames_of(file, FormSettings(names=COLUMNS))).load()
        times.append(time.process_time() - began)
    return size / min(times) / 1e6


def main() -> None:
    """Measure all forms, or one in this process (as each fresh process does)."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--particles", type=int, default=81_000)
    parser.add_argument("--frames", type=int, default=400)
    parser.add_argument("--forms", nargs="+", choices=FORMS, default=list(FORMS))
    parser.add_argument("--output", type=Path, default=Path("results/benchmark_import.csv"))
    parser.add_argument("--folder", type=Path, help="where the files go meanwhile")
    parser.add_argument("--measured", type=Path, help="folder to import in this process; one form")
    given = parser.parse_args()
    if given.measured:
        print(json.dumps(measure(given.forms[0], given.measured)))
        return
    rows: list[dict[str, Any]] = []
    for form in given.forms:
        with tempfile.TemporaryDirectory(dir=given.folder) as folder:
            files = Path(folder) / "files"
            write_files(form, files, given.particles, given.frames)
            command = [sys.executable, __file__, "--forms", form, "--measured", str(files)]
            done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
            numbers = json.loads(done.stdout.splitlines()[-1])
            rows.append({"form": form, "frames": given.frames} | numbers)
            print({key: round(value, 1) for key, value in numbers.items()}, form, file=sys.stderr, flush=True)
    write_csv(pd.DataFrame(rows, columns=FIELDS), given.output)
    print(machine())


if __name__ == "__main__":
    main()
