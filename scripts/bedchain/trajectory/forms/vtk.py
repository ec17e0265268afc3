# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in VTK's files, one a file: legacy (.vtk), VTP, VTU, and PVD collections."""

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.errors import DataError
from bedchain.trajectory.forms import legacy_vtk, vtk_process
from bedchain.trajectory.forms.raw import PARTICLE, Columns, RawFrame, our_columns

HEAD_BYTES = 4096
# zlib's best ratio: a header that announces more points than that cannot be true
MOST_RATIO = 1032
# kinds of data sets whose points may be particles
PARTICLES = (
    "POLYDATA",
    "UNSTRUCTURED_GRID",
    "PolyData",
    "UnstructuredGrid",
    "PPolyData",
    "PUnstructuredGrid",
)
LEGACY_COUNTS = re.compile(
    rb"^[ \t]*(?:(?:POINTS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS|CELLS|CELL_TYPES|POINT_DATA|CELL_DATA)"
    rb"[ \t]+"
    rb"(\S+)(?:[ \t]+(-?\d+))?|\S+[ \t]+(-?\d+)[ \t]+(-?\d+)[ \t]+[a-z_]+[ \t]*$)",
    re.MULTILINE,
)
XML_COUNTS = re.compile(rb"\b(?:NumberOf\w+)\s*=\s*\"([^\"]*)\"")


class VtkKind(NamedTuple):
    """Header of a VTK file: kind of its data set, as written there, and its points where it says so."""

    dataset: str
    points: int | None


def kind_of(head: bytes) -> VtkKind | None:
    """Kind of a VTK file by its first bytes; None for anything else.

    Raises
    ------
    DataError
        It is VTK, and its header is broken.
    """
    if head.startswith(b"# vtk DataFile"):
        dataset = re.search(rb"^[ \t]*DATASET[ \t]+(\w+)", head, re.MULTILINE | re.IGNORECASE)
        if dataset is None:
            raise DataError("a legacy VTK file without a line DATASET")
        points = re.search(rb"^[ \t]*POINTS[ \t]+(\d{1,18})\b", head, re.MULTILINE)
        return VtkKind(dataset[1].decode("ascii").upper(), int(points[1]) if points else None)
    if b"<VTKFile" in head:
        dataset = re.search(rb"<VTKFile[^>]*\btype\s*=\s*[\"'](\w+)[\"']", head)
        if dataset is None:
            raise DataError("an XML file of VTK whose tag VTKFile has no type")
        points = re.search(rb"\bNumberOfPoints\s*=\s*[\"'](\d{1,18})[\"']", head)
        return VtkKind(dataset[1].decode("ascii"), int(points[1]) if points else None)
    return None


def read_frame(path: Path, kind: VtkKind, renamed: Mapping[str, str]) -> RawFrame:
    """The frame of a file; it is read when the frame is loaded.

    Parameters
    ----------
    path : Path
        Not compressed.
    kind : VtkKind
    renamed : mapping of str to str
        Our name -> name in the file.
    """
    return RawFrame(PARTICLE, partial(_values, path, renamed), number=kind.points)


def collection(path: Path) -> Iterator[tuple[float, Path]]:
    """Time and file of each frame that a PVD file lists.

    Raises
    ------
    DataError
        It cannot be read as XML, or an entry has no time or file.
    """
    try:
        # expat, from 2.4.1 on, limits what entities expand to
        entries = ElementTree.parse(path).getroot().iter("DataSet")  # noqa: S314
        for entry in entries:
            time = float(entry.attrib["timestep"])
            if not np.isfinite(time):
                raise ValueError(f"the time {time}")
            yield time, path.parent / entry.attrib["file"]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise DataError(f"no readable collection of VTK files ({error!r})") from error


def _values(path: Path, renamed: Mapping[str, str]) -> Columns:
    """Points and their data; the numbers in the header are compared with the size of the file first."""
    content = path.read_bytes()
    if legacy_vtk.is_early(content):
        of_file = legacy_vtk.read_values(content)
    else:
        _check_counts(content)
        of_file = vtk_process.read_values(path)
    values = _named(of_file)
    places, arrays = our_columns(list(values), renamed), list(values.values())
    return {name: arrays[places[name]] for name in PARTICLE if name in places}


def _named(of_file: legacy_vtk.Values) -> Columns:
    """Columns by names: those of the points, then arrays with their component's number behind the name."""
    points = of_file.points
    values = {f"points{axis}": points[:, axis] for axis in range(3)}
    for name, array in of_file.fields.items():
        columns = array.reshape(len(array), -1).T if array.size else array.reshape(0, 1).T
        values |= (
            {name: columns[0]} if len(columns) == 1 else {f"{name}{at}": c for at, c in enumerate(columns)}
        )
    return values


def _check_counts(content: bytes) -> None:
    """Refuse a header whose numbers of points, cells or values are beyond what the file can hold."""
    legacy = content.startswith(b"# vtk DataFile")
    most = len(content) if legacy else MOST_RATIO * len(content)
    for match in (LEGACY_COUNTS if legacy else XML_COUNTS).finditer(content):
        for number in filter(None, match.groups()):
            if not number.strip().isdigit() or len(number) > 18 or int(number) > most:
                raise DataError(
                    f"its header announces {number[:30].decode('latin-1')} values, in {len(content)} bytes"
                )
