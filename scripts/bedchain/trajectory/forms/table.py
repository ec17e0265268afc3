# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in tables, separated by commas, semicolons, tabs or blanks: one frame a file, or one long table."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd

from bedchain.errors import DataError
from bedchain.trajectory.forms.lammps_text import number_table
from bedchain.trajectory.forms.raw import PARTICLE, Columns, RawFrame, our_columns
from bedchain.trajectory.forms.streams import Source

ROWS = 200_000  # of a chunk
HEAD_LINES = 60
MOST_COLUMNS = 10_000
FEWEST_NUMBERS = 2


class Layout(NamedTuple):
    """Where a table's rows start, and what its columns are.

    Attributes
    ----------
    separator : str
        For pandas.
    names : list of str
        Of the columns, as in the file.
    first : bytes
        Lines read so far that are rows.
    """

    separator: str
    names: list[str]
    first: bytes


def layout_of(source: Source, names: Sequence[str] | None = None) -> Layout | None:
    """Layout of a table by its first lines, which are read; None where nothing looks like rows of numbers.

    Parameters
    ----------
    source : Source
        At the start of the file.
    names : sequence of str, optional
        Of the columns, where the file has none.

    Raises
    ------
    DataError
        There are rows of numbers without names of columns.
    """
    before: list[str] = []
    for _ in range(HEAD_LINES):
        line = source.line()
        if line is None:
            return None
        text = line.decode("utf-8-sig" if not before else "utf-8", "replace").strip()
        for separator, pandas_separator in ((",", ","), (";", ";"), ("\t", "\t"), (None, r"\s+")):
            words = [word.strip() for word in text.split(separator)]
            if FEWEST_NUMBERS <= len(words) <= MOST_COLUMNS and not text.startswith("#") and _is_row(words):
                header = list(names) if names else _header(before, separator, len(words))
                if len(header) != len(words):
                    raise DataError(f"frames.names has {len(header)} names for {len(words)} columns")
                return Layout(pandas_separator, header, line)
        before.append(text)
    return None


def _is_row(words: Sequence[str]) -> bool:
    numbers = 0
    for word in words:
        try:
            float(word)
            numbers += 1
        except ValueError:
            continue
    return numbers >= max(FEWEST_NUMBERS, len(words) - FEWEST_NUMBERS)


def _header(before: Sequence[str], separator: str | None, columns: int) -> list[str]:
    """Names of columns in the last line before the rows that has as many words."""
    for line in reversed([line for line in before if line]):
        words = [word.strip().strip('"') for word in line.lstrip("#").strip().split(separator)]
        if len(words) == columns:
            return words
        break
    raise DataError(
        f"a table of {columns} columns without their names: name them in frames.names, such as [time, id, "
        "x, y, z]"
    )


def read_frames(source: Source, layout: Layout, renamed: Mapping[str, str]) -> Iterator[RawFrame]:
    """Frames of a table: rows of one time or step after another.

    Parameters
    ----------
    source : Source
        Behind the first row.
    layout : Layout
    renamed : mapping of str to str
        Our name -> name in the file.

    Yields
    ------
    RawFrame

    Raises
    ------
    DataError
        A row does not fit, or a time comes back after another.
    """
    places = our_columns(layout.names, renamed)
    clock = next((name for name in ("time", "step") if name in places), None)
    wanted = {name: at for name, at in places.items() if name in (*PARTICLE, clock)}
    waiting = None
    for table in _chunks(source, layout, wanted):
        if waiting is not None:
            table = pd.concat((waiting, table), ignore_index=True)
        if clock is None:
            waiting = table
            continue
        times = table[clock].to_numpy()
        if not np.isfinite(times).all():
            raise DataError(f"a row has no {clock}")
        starts = np.flatnonzero(np.r_[True, np.diff(times) != 0])
        for begin, end in zip(starts[:-1], starts[1:], strict=True):
            yield _frame(table.iloc[begin:end], clock)
        waiting = table.iloc[starts[-1] :]
    if waiting is not None:
        yield _frame(waiting, clock)


def _chunks(source: Source, layout: Layout, wanted: Mapping[str, int]) -> Iterator[pd.DataFrame]:
    rows = layout.first
    while True:
        body, count = source.lines(ROWS)
        content = rows + body
        if content.strip():
            yield _table(content, layout, wanted)
        if count < ROWS:
            return
        rows = b""


def _table(content: bytes, layout: Layout, wanted: Mapping[str, int]) -> pd.DataFrame:
    places = sorted(set(wanted.values()))
    table = number_table(content, layout.separator, len(layout.names), places)
    return pd.DataFrame({name: table[at].to_numpy() for name, at in wanted.items()})


def _frame(table: pd.DataFrame, clock: str | None) -> RawFrame:
    columns = tuple(name for name in PARTICLE if name in table)
    value = None if clock is None else float(table[clock].iloc[0])
    step = int(value) if clock == "step" and value is not None else None
    return RawFrame(
        columns,
        partial(_values, table, columns),
        step,
        value if clock == "time" else None,
        len(table),
    )


def _values(table: pd.DataFrame, columns: Sequence[str]) -> Columns:
    return {name: table[name].to_numpy() for name in columns}
