# SPDX-License-Identifier: GPL-3.0-or-later
"""What LIGGGHTS and bedFoam leave behind, in their formats, of particles at rest on a line."""

import struct
from pathlib import Path

import numpy as np

from bedchain.dem.restarts import GAS_FIELDS
from bedchain.trajectory.dumps import HEADER

END_MARK = "// ************************************************************************* //\n"


def write_dump(file: Path, step: int, number: int, columns: int = 5) -> None:
    """A frame in LIGGGHTS's native binary form: particles 1 mm apart along x, 5 mm above the floor."""
    values = np.zeros((number, columns))
    values[:, 0], values[:, 1], values[:, 2] = np.arange(1, number + 1), 1e-3 * np.arange(number), 5e-3
    header = np.zeros(1, HEADER)
    header["step"], header["number"], header["columns"], header["chunks"] = step, number, columns, 1
    file.write_bytes(header.tobytes() + struct.pack("<i", values.size) + values.tobytes())


def write_restart(file: Path, number: int, ranks: int = 1, word: bytes = b"LIGGGHTS") -> None:
    """A restart: a header that begins with a word, then each rank's particles of 20 to 22 values each."""
    content = word + b"\0" * 200
    for part in np.array_split(np.arange(number), ranks):
        values = np.concatenate([np.full(20 + n % 3, 20.0 + n % 3) for n in part])
        content += struct.pack("<i", values.size) + values.tobytes()
    file.write_bytes(content)


def write_gas(gas: Path, end_s: float, ranks: int = 1) -> None:
    """Mesh and last fields of an OpenFOAM case."""
    for part in [gas / f"processor{rank}" for rank in range(ranks)] if ranks > 1 else [gas]:
        names = [f"{end_s:g}/{name}" for name in GAS_FIELDS]
        for name in [*names, "constant/polyMesh/faces", "constant/polyMesh/points"]:
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            (part / name).write_text(f"FoamFile {name}\n{'0 ' * 99}\n{END_MARK}", encoding="utf-8")


def write_series(file: Path, start_s: float, end_s: float, row_s: float) -> None:
    """The time series of a segment, a row each ``row_s``."""
    file.parent.mkdir(parents=True, exist_ok=True)
    times = start_s + row_s * np.arange(1, round((end_s - start_s) / row_s) + 1)
    rows = "".join(f"{time:.10g},0.1\n" for time in times)
    file.write_text("time_s,mean_height_m\n" + rows, encoding="utf-8")
