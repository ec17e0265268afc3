# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in a numpy .npz: positions (n_frames, n_particles, 2 or 3), or a column an array.

A column is (n_frames, n_particles). Further arrays: times_s or steps (n_frames,), ids, type, radius
(n_particles,), velocities as the positions. An array named by its columns, such as x_z_vx_vz, is
(n_frames, n_columns, n_particles).
"""

import zipfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from numpy.lib import format as npy_format

from bedchain.array_files import map_array
from bedchain.errors import DataError
from bedchain.trajectory.forms.raw import PARTICLE, Columns, RawFrame, plain

MOST_RATIO = 1032  # zlib's best
Arrays = dict[str, np.ndarray]
PER_PARTICLE = ("id", "type", "radius", "diameter")
SHORT = {"ids": "id", "types": "type", "radii": "radius", "times": "time", "t": "time", "steps": "step"}


def read_frames(path: Path) -> Iterator[RawFrame]:
    """Frames of an .npz; arrays that are not compressed are mapped, the others unpacked whole.

    Parameters
    ----------
    path : Path

    Yields
    ------
    RawFrame

    Raises
    ------
    DataError
        It is no .npz, holds no positions, or arrays do not fit.
    """
    arrays = _arrays(path)
    columns = _columns(arrays)
    if not {"x", "y", "z"} & columns.keys():
        raise DataError(f"no positions among its arrays ({', '.join(arrays)}): save positions or x, y, z")
    shape = next(columns[name].shape for name in ("x", "y", "z") if name in columns)
    for name, array in columns.items():
        if array.shape != shape and not (name in PER_PARTICLE and array.shape == shape[1:]):
            raise DataError(f"{name} has the shape {array.shape}, {shape} (frames, particles) expected")
    series = {name: array for name, array in arrays.items() if name in ("time", "step")}
    for name, array in series.items():
        if array.shape != shape[:1] or array.dtype.kind not in "iuf" or not np.isfinite(array).all():
            raise DataError(
                f"{name}s has the shape {array.shape}, finite numbers for {shape[0]} frames expected"
            )
    steps, times = series.get("step"), series.get("time")
    for frame in range(shape[0]):
        yield RawFrame(
            tuple(name for name in PARTICLE if name in columns),
            partial(_values, columns, frame),
            None if steps is None else int(steps[frame]),
            None if times is None else float(times[frame]),
            shape[1],
        )


def _values(columns: Arrays, frame: int) -> Columns:
    return {name: np.array(array if array.ndim == 1 else array[frame]) for name, array in columns.items()}


def _arrays(path: Path) -> Arrays:
    arrays: Arrays = {}
    try:
        with zipfile.ZipFile(path) as archive:
            entries = [entry for entry in archive.infolist() if entry.filename.endswith(".npy")]
            for entry in entries:
                key = plain(entry.filename[:-4]) if "_" not in entry.filename else entry.filename[:-4].lower()
                key = SHORT.get(key.removesuffix("_s").removesuffix("_m"), key.removesuffix("_m"))
                _check_size(archive, entry, path)
                if entry.compress_type == zipfile.ZIP_STORED:
                    arrays[key] = map_array(path, entry.filename[:-4])
                else:
                    with archive.open(entry) as stream:
                        arrays[key] = npy_format.read_array(stream, allow_pickle=False)
    except DataError:
        raise
    except Exception as error:
        raise DataError(f"no readable .npz ({error})") from error
    if not arrays:
        raise DataError("a zip archive without arrays of numpy")
    return arrays


def _check_size(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, path: Path) -> None:
    """Refuse an array larger than its entry, or an entry larger than the file can hold."""
    with archive.open(entry) as stream:
        version = npy_format.read_magic(stream)
        read = npy_format.read_array_header_1_0 if version == (1, 0) else npy_format.read_array_header_2_0
        shape, _, dtype = read(stream)
    if dtype.hasobject:
        raise DataError(f"{entry.filename} holds Python objects, not numbers")
    size = dtype.itemsize
    for length in shape:
        size *= length  # of Python: does not overflow
    if size > entry.file_size or entry.file_size > MOST_RATIO * max(path.stat().st_size, 1):
        raise DataError(f"{entry.filename} announces {shape} values, more than the file holds")


def _columns(arrays: Arrays) -> Arrays:
    """Arrays by the names of single columns."""
    columns: Arrays = {}
    for key, array in arrays.items():
        parts = key.split("_")
        if key in ("positions", "velocities") and array.ndim == 3 and array.shape[2] in (2, 3):
            names = ("x", "y", "z") if array.shape[2] == 3 else ("x", "z")
            prefix = "v" if key == "velocities" else ""
            columns |= {prefix + name: array[:, :, at] for at, name in enumerate(names)}
        elif len(parts) > 1 and all(part in PARTICLE for part in parts) and array.ndim == 3:
            if array.shape[1] != len(parts):
                raise DataError(f"{key} has the shape {array.shape}, {len(parts)} columns expected")
            columns |= {part: array[:, at] for at, part in enumerate(parts)}
        elif key in PARTICLE and array.ndim in (1, 2):
            columns[key] = array
    if wrong := [name for name, array in columns.items() if array.dtype.kind not in "iufb"]:
        raise DataError(f"{', '.join(wrong)}: no numbers")
    return columns
