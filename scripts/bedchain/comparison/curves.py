# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing curves as rows of mixing.csv, and the errors of a curve."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.measures.mixing import GROUPS


def curves_of(table: pd.DataFrame, source: str, n_times: int) -> NDArray[np.float64]:
    """Curves of one source of mixing.csv.

    Parameters
    ----------
    table : DataFrame
        time_s, source, direction, group, fraction_remaining_1.
    source : str
    n_times : int
        Number of times that the curves must have.

    Returns
    -------
    (n_times, 4) ndarray
        In the order of `mixing.GROUPS` [1].

    Raises
    ------
    UserError
        The source is missing, or has another number of times.
    """
    rows = table[table["source"] == source]
    columns = [rows[rows["group"] == group].sort_values("time_s") for _, group in GROUPS]
    if {len(column) for column in columns} != {n_times}:
        raise UserError(f"{source}: {len(columns[0])} times, {n_times} expected; make its mixing.csv again")
    return np.column_stack([column["fraction_remaining_1"] for column in columns])


@dataclass(frozen=True)
class ChainFiles:
    """Chains that were run over the comparison window.

    Attributes
    ----------
    models : list of str
        Names.
    chains : list of Path
        ``chain_<model>.npz`` of each.
    """

    models: list[str]
    chains: list[Path]

    def by_model(self) -> dict[str, Path]:
        """Name -> file."""
        return dict(zip(self.models, self.chains, strict=True))


def curve_table(times_s: np.ndarray, source: str, remaining: np.ndarray) -> pd.DataFrame:
    """Curves of one source as rows of mixing.csv.

    Parameters
    ----------
    times_s : (n_times,) ndarray
        [s].
    source : str
        ``dem``, a model, or a model with ``_monte_carlo``.
    remaining : (n_times, 4) ndarray
        Share of each group of `mixing.GROUPS` that is on its side [1].

    Returns
    -------
    DataFrame
        time_s, source, direction, group, fraction_remaining_1.
    """
    parts = [
        pd.DataFrame(
            {
                "time_s": times_s,
                "source": source,
                "direction": direction,
                "group": group,
                "fraction_remaining_1": remaining[:, column],
            }
        )
        for column, (direction, group) in enumerate(GROUPS)
    ]
    return pd.concat(parts, ignore_index=True)


def curve_errors(model: np.ndarray, dem: np.ndarray) -> dict[str, np.ndarray]:
    """Signed mean, rms and final value of the errors of curves against the DEM's.

    Parameters
    ----------
    model : (..., n_times, 4) ndarray
        Share of each group on its side, from the start on [1]. The start itself, where all curves are 1 by
        definition, does not count.
    dem : (n_times, 4) ndarray

    Returns
    -------
    dict of str to (..., 4) ndarray
        error_signed and error_rms over the times, and crossed_end, the share that has crossed at the end [1].
    """
    error = model[..., 1:, :] - dem[1:]
    return {
        "error_signed": error.mean(axis=-2),
        "error_rms": np.sqrt((error**2).mean(axis=-2)),
        "crossed_end": 1 - model[..., -1, :],
    }
