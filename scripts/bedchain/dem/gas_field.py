# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of the gas, from the OpenFOAM case of a segment or from an archive."""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyvista

from bedchain.array_files import read_arrays
from bedchain.errors import DataError, UserError, make_again
from bedchain.files import path_inside


class GasField(NamedTuple):
    """A scalar in the cells of the gas.

    Attributes
    ----------
    time_s : float
        Time of the field [s].
    x_m, z_m : (n_gas_cells,) ndarray
        Centres of the gas cells [m].
    values : (n_gas_cells,) ndarray
        Values of the field, in its unit.
    mesh : pyvista.DataSet
        The cells, with the field.
    """

    time_s: float
    x_m: np.ndarray
    z_m: np.ndarray
    values: np.ndarray
    mesh: Any


def gas_near(manifest: dict[str, Any], folder: Path, name: str, time_s: float) -> GasField:
    """A field of the gas at the stored time nearest to a given one.

    Parameters
    ----------
    manifest : dict
        Of the DEM run; that of an unpacked archive names the file of the gas.
    folder : Path
        Folder of the manifest.
    name : str
        Field, such as ``voidage``.
    time_s : float
        Wanted time [s].

    Returns
    -------
    GasField
    """
    if "gas" in manifest:
        return archived_gas(path_inside(folder, manifest["gas"]), name, time_s)
    case, _ = nearest_gas(manifest, folder, name, time_s)
    return read_gas_field(case, name)


def archived_gas(file: Path, name: str, time_s: float) -> GasField:
    """A field from the archived times of the gas.

    Parameters
    ----------
    file : Path
        ``gas.npz``: times_s (n_times,); x_m, z_m (n_gas_cells,), row by row; fields (n_times, n_gas_cells).
    name : str
        Field, such as ``voidage``.
    time_s : float
        Wanted time [s].

    Returns
    -------
    GasField

    Raises
    ------
    DataError
        The file is not such a file.
    """
    arrays = read_arrays(file)
    try:
        return _nearest(arrays, name, time_s)
    except (ValueError, TypeError, IndexError) as error:
        raise DataError(f"{file} holds no times of a gas ({error}); {make_again(file)}") from error


def _nearest(arrays: Mapping[str, np.ndarray], name: str, time_s: float) -> GasField:
    index = int(np.argmin(np.abs(arrays["times_s"] - time_s)))
    x, z = np.unique(arrays["x_m"]), np.unique(arrays["z_m"])
    # centres lie half a cell inside the walls
    spacing = ((x[0] + x[-1]) / len(x), 1.0, (z[0] + z[-1]) / len(z))
    mesh = pyvista.ImageData(dimensions=(len(x) + 1, 2, len(z) + 1), spacing=spacing, origin=(0.0, -0.5, 0.0))
    values = np.asarray(arrays[name][index], float)
    mesh.cell_data[name] = values
    return GasField(float(arrays["times_s"][index]), arrays["x_m"], arrays["z_m"], values, mesh)


def nearest_gas(manifest: dict[str, Any], folder: Path, name: str, time_s: float) -> tuple[Path, float]:
    """OpenFOAM case of the segment that still has its gas and ends nearest to a time.

    Parameters
    ----------
    manifest : dict
        Of the DEM run; its segments' folders are relative to ``folder``.
    folder : Path
    name : str
        Field, such as ``voidage``.
    time_s : float
        Wanted time [s].

    Returns
    -------
    Path
        OpenFOAM case.
    float
        Time of its end [s].

    Raises
    ------
    UserError
        No segment has the field, or a folder of the manifest is out of the run's folder.
    """
    cases = [
        (path_inside(folder, f"{segment['folder']}/gas"), float(segment["end_s"]))
        for segment in manifest["segments"]
    ]
    candidates = [(abs(end_s - time_s), case, end_s) for case, end_s in cases if any(case.glob(f"**/{name}"))]
    if not candidates:
        raise UserError(f"{folder}: no segment has the gas field {name}; run run_dem again")
    _, case, end_s = min(candidates)
    return case, end_s


def read_gas_field(case: Path, name: str) -> GasField:
    """A cell field at the last time of an OpenFOAM case.

    Parameters
    ----------
    case : Path
        With its times in it, or in its folders processor0, processor1, ...
    name : str
        Field, such as ``voidage``.

    Returns
    -------
    GasField

    Raises
    ------
    UserError
        The case has no such field, or holds a special file or a link that leads out of it.
    """
    for part in case.rglob("*"):  # the reader waits for ever at a pipe
        path_inside(case, str(part.relative_to(case)))
    # the reader needs a file beside the folders of the case, which must not change: links to them serve
    with tempfile.TemporaryDirectory() as temporary:
        for part in case.iterdir():
            (Path(temporary) / part.name).symlink_to(part.resolve())
        marker = Path(temporary) / "gas.foam"
        marker.touch()
        reader = pyvista.POpenFOAMReader(str(marker))
        reader.case_type = "decomposed" if (case / "processor0").exists() else "reconstructed"
        reader.cell_to_point_creation = False
        reader.set_active_time_value(reader.time_values[-1])
        mesh: Any = reader.read()["internalMesh"]
    if name not in mesh.cell_data:
        raise UserError(f"{case} has no field {name} at {reader.time_values[-1]:g} s; run run_dem again")
    centres = mesh.cell_centers().points
    return GasField(
        float(reader.time_values[-1]), centres[:, 0], centres[:, 2], np.asarray(mesh.cell_data[name]), mesh
    )
