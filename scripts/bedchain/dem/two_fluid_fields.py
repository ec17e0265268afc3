# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of a two-fluid run on its grid of nx by nz cells: solids, and the solids that crossed each face."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError

Array = NDArray[np.float64]
NUMBER = rb"[-+.\deE]+"
VALUES = re.compile(
    rb"internalField\s+(?:nonuniform List<(?:scalar|vector)>\s*(\d+)\s*\("
    rb"|uniform\s+\(?(" + NUMBER + rb"(?: " + NUMBER + rb")*)\)?\s*;)"
)


class Flow(NamedTuple):
    """Frames of a two-fluid run.

    Attributes
    ----------
    times_s : (n_frames,) array
        Ends of the frames [s].
    solids : (n_frames, nz, nx) array
        Share of the solids at the end of a frame [1].
    right : (n_frames, nz, nx - 1) array
        Solids that crossed each face to the right within the frame, a mean over it [m3/s].
    up : (n_frames, nz - 1, nx) array
        The same upwards.
    """

    times_s: Array
    solids: Array
    right: Array
    up: Array


def read_scalars(file: Path, number: int) -> Array:
    """Values inside the mesh of a field that OpenFOAM wrote as binary.

    Parameters
    ----------
    file : Path
        A volScalarField or surfaceScalarField.
    number : int
        Of cells, or of faces inside.

    Returns
    -------
    (number,) ndarray

    Raises
    ------
    DataError
        The file holds another number of values, or is cut off.
    """
    return _read(file, number, 1)[:, 0]


def read_vectors(file: Path, number: int) -> Array:
    """`read_scalars` of a volVectorField, (number, 3)."""
    return _read(file, number, 3)


def _read(file: Path, number: int, parts: int) -> Array:
    content = file.read_bytes()
    match = VALUES.search(content)
    if match is None:
        raise DataError(f"{file} holds no {'scalar' if parts == 1 else 'vector'} field of OpenFOAM")
    if match[2]:
        return np.tile([float(value) for value in match[2].split()], (number, 1))
    if int(match[1]) != number or len(content) < match.end() + 8 * parts * number:
        raise DataError(f"{file} holds {int(match[1])} values or is cut off, {number} expected")
    return np.frombuffer(content, "<f8", parts * number, match.end()).reshape(number, parts).copy()


def split_faces(values: Array, nz: int, nx: int) -> tuple[Array, Array]:
    """Values of the faces inside a mesh of blockMesh as (nz, nx - 1) to the right and (nz - 1, nx) upwards.

    OpenFOAM numbers faces by their lower cell, then by their upper one: of a cell, the face to the right
    comes before the one above.
    """
    cells = np.arange(nz * nx).reshape(nz, nx)
    lower = np.concatenate([cells[:, :-1].ravel(), cells[:-1].ravel()])
    upper = np.concatenate([cells[:, 1:].ravel(), cells[1:].ravel()])
    place = np.empty(len(lower), np.int64)
    place[np.lexsort((upper, lower))] = np.arange(len(lower))
    by_kind = values[place]
    cut = nz * (nx - 1)
    return by_kind[:cut].reshape(nz, nx - 1), by_kind[cut:].reshape(nz - 1, nx)


def read_frame(folder: Path, nz: int, nx: int, density: float) -> tuple[Array, Array, Array]:
    """Solids and their flow of one time folder, as a frame of `Flow`; `density` of the solids [kg/m3]."""
    solids = read_scalars(folder / "alpha.particles", nz * nx).reshape(nz, nx)
    faces = nz * (nx - 1) + (nz - 1) * nx
    mass = read_scalars(folder / "alphaRhoPhi.particlesMean", faces)
    return solids, *split_faces(mass / density, nz, nx)
