# SPDX-License-Identifier: GPL-3.0-or-later
"""Text dumps of LIGGGHTS and LAMMPS: one frame a file or many in one, ``ITEM:`` lines in any order."""

import io
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import numpy as np
import pandas as pd

from bedchain.errors import DataError
from bedchain.trajectory.forms.raw import PARTICLE, Columns, CutOffError, RawFrame, our_columns, unscaled
from bedchain.trajectory.forms.streams import Source

# pandas takes other words for missing numbers, which a dump cannot mean
NOT_A_NUMBER = {"keep_default_na": False, "na_values": ["nan", "-nan", "NaN", "-NaN", "NAN"]}
MOST_PARTICLES = 2**31 - 1
TRICLINIC = "a triclinic box: only boxes with right angles can be cut into cells"


def read_frames(source: Source, renamed: Mapping[str, str], keep: bool = True) -> Iterator[RawFrame]:
    """Frames of a text dump, in the order of the file.

    Parameters
    ----------
    source : Source
    renamed : mapping of str to str
        Our name -> name in the file.
    keep : bool
        Whether particles are wanted; without, only headers are read and the calls of the frames fail.

    Yields
    ------
    RawFrame

    Raises
    ------
    DataError
        A header is no header of a dump, or a box is triclinic; a frame's own faults are raised by its call.
    CutOffError
        The file ends inside a frame.
    """
    while (header := _header(source)) is not None:
        names = header["ATOMS"]
        places = our_columns(names, renamed)
        number = header.get("NUMBER OF ATOMS")
        if number is None:
            raise DataError("a frame without ITEM: NUMBER OF ATOMS")
        step, box = header.get("TIMESTEP"), header.get("BOX BOUNDS")
        body, lines = source.lines(number, keep)
        if lines < number:
            raise CutOffError(f"the frame of step {step} is cut off: {lines} of {number} particles are there")
        columns = tuple(name for name in PARTICLE if name in places)
        yield RawFrame(
            columns,
            partial(_values, body, names, {name: places[name] for name in columns}, box),
            step,
            header.get("TIME"),
            number,
            box,
            header.get("periodic", (False, False, False)),
        )


def _header(source: Source) -> dict | None:
    """Items of the next frame up to its line of columns; None at the end of the file."""
    items: dict = {}
    while (line := source.line()) is not None:
        text = line.decode("ascii", "replace").strip()
        if not text:
            continue
        whole = line.endswith(b"\n") or text.startswith("ITEM: ATOMS")
        if not whole:
            raise CutOffError("the last frame is cut off in its header")
        if not text.startswith("ITEM:"):
            raise DataError(f"{text[:60]!r} stands where an ITEM: line of a dump is expected")
        name, rest = _item(text[5:].strip())
        if name == "ATOMS":
            if not line.endswith(b"\n") and items.get("NUMBER OF ATOMS", 1):
                raise CutOffError(f"the frame of step {items.get('TIMESTEP')} is cut off in its header")
            if not rest:
                raise DataError("ITEM: ATOMS names no columns: write them with dump custom")
            items[name] = rest
            return items
        items |= _content(name, rest, source)
    if items:
        raise CutOffError(f"the frame of step {items.get('TIMESTEP')} is cut off in its header")
    return None


KNOWN = ("TIMESTEP", "NUMBER OF ATOMS", "BOX BOUNDS", "ATOMS", "UNITS", "TIME")


def _item(text: str) -> tuple[str, list[str]]:
    for name in KNOWN:
        if text == name or text.startswith(name + " "):
            return name, text[len(name) :].split()
    raise DataError(f"ITEM: {text[:60]} is no item of a dump of particles")


def _content(name: str, rest: Sequence[str], source: Source) -> dict:
    if name == "BOX BOUNDS":
        return _box(rest, [_next(source) for _ in range(3)])
    text = _next(source)
    try:
        if name == "UNITS":
            return {}
        if name == "TIME":
            time = float(text)
            if not np.isfinite(time):
                raise ValueError
            return {name: time}
        value = int(text)
        if not 0 <= value <= (MOST_PARTICLES if name == "NUMBER OF ATOMS" else 2**62):
            raise ValueError
    except ValueError:
        raise DataError(f"ITEM: {name} has the value {text[:40]!r}") from None
    return {name: value}


def _next(source: Source) -> str:
    line = source.line()
    if line is None or not line.endswith(b"\n"):
        raise CutOffError("the last frame is cut off in its header")
    return line.decode("ascii", "replace").strip()


def _box(flags: Sequence[str], lines: Sequence[str]) -> dict:
    words = [line.split() for line in lines]
    if {"xy", "xz", "yz", "abc"} & set(flags) or any(len(row) > 2 for row in words):
        raise DataError(TRICLINIC)
    try:
        box = np.array(words, float)
        if box.shape != (3, 2) or not np.isfinite(box).all():
            raise ValueError
    except ValueError:
        raise DataError(f"ITEM: BOX BOUNDS has the values {'; '.join(lines)[:60]!r}") from None
    sides = [flag == "pp" for flag in flags]
    return {"BOX BOUNDS": box, "periodic": tuple(sides) if len(sides) == 3 else (False,) * 3}


def _values(body: bytes, names: Sequence[str], places: dict[str, int], box: np.ndarray | None) -> Columns:
    """Columns of a frame's lines, by pandas, which reads 0.1 GB/s."""
    if not body:
        return {name: np.empty(0) for name in places}
    table = number_table(body, r"\s+", len(names), sorted(places.values()))
    values = {name: table[at].to_numpy() for name, at in places.items()}
    return unscaled(values, names, box)


def _check_words(body: bytes, separator: str, columns: int) -> None:
    """Refuse lines of too many words, which pandas would cut: by the number of separators where that is "
    "sure."""
    lines = body.count(b"\n") + (not body.endswith(b"\n"))
    sign = b" " if separator == r"\s+" else separator.encode()
    if body.count(sign) in (lines * (columns - 1), lines * columns) and (sign != b" " or b"\t" not in body):
        return
    split = None if sign == b" " else sign
    for line in body.splitlines():
        if line.strip() and len(line.split(split)) > columns + (
            split is not None and line.rstrip().endswith(sign)
        ):
            raise DataError(f"a line is no row of {columns} numbers ({line[:60].decode('latin-1')!r})")


def number_table(
    body: bytes, separator: str, columns: int, wanted: Sequence[int], as_written: bool = True
) -> pd.DataFrame:
    """Lines of numbers as a table of the wanted columns.

    Raises
    ------
    DataError
        A line has more or fewer words than columns, or a word that is no number; no column is wanted.
    """
    if not wanted:
        raise DataError("none of its columns is an id, a place or a velocity: name them in frames.columns")
    _check_words(body, separator, columns)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = pd.read_csv(
                io.BytesIO(body), sep=separator, header=None, names=range(columns), index_col=False,
                usecols=list(wanted), dtype=np.float64, engine="c", skip_blank_lines=True,
                na_filter=not as_written, quoting=3, encoding="latin-1",
                **({} if as_written else NOT_A_NUMBER),
            )  # fmt: skip
    except (ValueError, Warning, OverflowError) as error:
        if as_written and b"nan" in body.lower():
            return number_table(body, separator, columns, wanted, as_written=False)
        raise DataError(f"a line is no row of {columns} numbers ({error})") from error
    return table
