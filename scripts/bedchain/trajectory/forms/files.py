# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a file of any form, in the order of the file."""

import re
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bedchain.errors import DataError
from bedchain.trajectory.forms import lammps_binary, lammps_text, npz, table, vtk
from bedchain.trajectory.forms.raw import CutOffError, RawFrame
from bedchain.trajectory.forms.sniff import Form, form_of, head_of
from bedchain.trajectory.forms.streams import Source, opened


@dataclass(frozen=True)
class FormSettings:
    """How files are to be read.

    Parameters
    ----------
    form : str, optional
        One of `sniff.FORMS`; without it the content decides.
    names : tuple of str, optional
        Of the columns, where the form has none.
    columns : dict of str to str
        Our name of a column -> name in the files.
    """

    form: Form | None = None
    names: tuple[str, ...] | None = None
    columns: dict[str, str] = field(default_factory=dict)


def frames_of(path: Path, settings: FormSettings, keep: bool = True) -> Iterator[RawFrame]:
    """Frames of a file; none where it holds no frame, such as LIGGGHTS's files of its box.

    Parameters
    ----------
    path : Path
        Opened for reading only.
    settings : FormSettings
    keep : bool
        Whether particles are wanted; without, headers only where the form allows.

    Yields
    ------
    RawFrame
        With a step from the file's name where the content has neither step nor time.

    Raises
    ------
    DataError
        The file cannot be read as its form; its name stands in the message.
    CutOffError
        It ends inside a frame; the frames before were given.
    """
    try:
        head, packed = head_of(path)
        form = settings.form or form_of(head)
        if form is None:
            return
        for frame in _frames(path, form, packed, settings, keep):
            clocked = frame.step is not None or frame.time is not None
            yield frame if clocked else frame._replace(step=step_in_name(path))
    except CutOffError as error:
        raise CutOffError(_named(path, error)) from error
    except DataError as error:
        raise DataError(_named(path, error)) from error
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror or error})") from error


def _named(path: Path, error: DataError) -> str:
    return str(error) if str(path) in str(error) else f"{path}: {error}"


def _frames(
    path: Path, form: Form, packed: str | None, settings: FormSettings, keep: bool
) -> Iterator[RawFrame]:
    if form in ("vtk", "pvd", "npz"):
        yield from _whole_file(path, form, packed, settings)
        return
    with opened(path) as stream:
        source = Source(stream)
        if form == "text":
            yield from lammps_text.read_frames(source, settings.columns, keep)
        elif form == "binary":
            yield from lammps_binary.read_frames(source, settings.columns, settings.names)
        elif layout := table.layout_of(source, settings.names):
            yield from table.read_frames(source, layout, settings.columns)
        else:
            raise DataError("no rows of numbers in its first lines")


def _whole_file(path: Path, form: Form, packed: str | None, settings: FormSettings) -> Iterator[RawFrame]:
    """Frames of a form whose reader takes a file, of which a compressed one is unpacked first."""
    if form == "pvd":
        for time, file in vtk.collection(path):
            for frame in frames_of(file, settings):
                yield frame._replace(step=None, time=time)
    elif form == "npz":
        yield from npz.read_frames(path)
    elif packed is None:
        yield _vtk_frame(path, settings)
    else:
        suffix = path.with_suffix("").suffix or ".vtk"

        def load() -> dict[str, Any]:
            with tempfile.TemporaryDirectory() as folder:
                return _vtk_frame(_unpacked(path, Path(folder) / f"frame{suffix}"), settings).load()

        with tempfile.TemporaryDirectory() as folder:
            frame = _vtk_frame(_unpacked(path, Path(folder) / f"frame{suffix}"), settings)
        yield frame._replace(load=load)


def _vtk_frame(path: Path, settings: FormSettings) -> RawFrame:
    with path.open("rb") as stream:
        kind = vtk.kind_of(stream.read(vtk.HEAD_BYTES))
    if kind is None:
        raise DataError("no file of VTK")
    return vtk.read_frame(path, kind, settings.columns)


def _unpacked(path: Path, target: Path) -> Path:
    with opened(path) as stream, target.open("wb") as file:
        shutil.copyfileobj(stream, file)
    return target


def step_in_name(path: Path) -> int | None:
    """The last number in a file's name, ``drum_12000.vtk.gz`` -> 12000; None without one."""
    stem = path.name.removesuffix(".gz").removesuffix(".xz").removesuffix(".zst")
    numbers = re.findall(r"\d{1,18}", Path(stem).stem if "." in stem else stem)
    return int(numbers[-1]) if numbers else None
