# SPDX-License-Identifier: GPL-3.0-or-later
"""What every stage script shares: its log, its errors, and files that appear only when they are complete."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import numpy as np
import pandas as pd

from bedchain.errors import UserError, report_user_errors
from bedchain.frames import DataError

LOG = logging.getLogger("bedchain")
CSV_DIGITS = "%.8g"


@contextmanager
def stage(log: Path | str) -> Iterator[None]:
    """Run a stage: what it reports goes to stderr and to its log, a user's error is one clear message.

    Parameters
    ----------
    log : path
        The rule's log file.

    Raises
    ------
    SystemExit
        Code 1, after a `UserError` or a `DataError`.
    """
    Path(log).parent.mkdir(parents=True, exist_ok=True)
    handlers: list[logging.Handler] = [logging.StreamHandler(), logging.FileHandler(log, mode="w")]
    for handler in handlers:
        handler.setFormatter(logging.Formatter("%(asctime)s %(message)s", "%H:%M:%S"))
        LOG.addHandler(handler)
    LOG.setLevel(logging.INFO)
    try:
        with report_user_errors(log):
            try:
                yield
            except DataError as error:
                raise UserError(str(error)) from error
    except Exception:
        LOG.exception("failed")
        raise
    finally:
        for handler in handlers:
            LOG.removeHandler(handler)
            handler.close()


@contextmanager
def complete(target: Path) -> Iterator[Path]:
    """A temporary name beside ``target`` to write to; moved to ``target`` if all went well, removed if not.

    Parameters
    ----------
    target : Path
        Its folder is made where missing.

    Yields
    ------
    Path
        With the suffix of ``target``, so that writers that look at it do the right thing.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def write_npy_header(stream: IO[bytes], shape: tuple[int, ...], dtype: np.dtype) -> None:
    """Begin an .npy file whose values follow as bytes, in C order, a part at a time.

    Parameters
    ----------
    stream : binary file
    shape : tuple of int
        Of the whole array.
    dtype : dtype
    """
    described = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, described)


def write_csv(table: pd.DataFrame, target: Path) -> None:
    """Write a table as csv, complete or not at all.

    Parameters
    ----------
    table : DataFrame
        Units stand in the names of the columns.
    target : Path
    """
    with complete(target) as temporary:
        table.to_csv(temporary, index=False, float_format=CSV_DIGITS)
