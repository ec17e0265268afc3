# SPDX-License-Identifier: GPL-3.0-or-later
"""Pareto front: the rows of a table that no other row beats in both cost and error."""

import numpy as np
import pandas as pd


def pareto_front(table: pd.DataFrame, cost: str, error: str) -> pd.DataFrame:
    """Rows of a table on the front of cost and error, by rising cost and so falling error.

    Parameters
    ----------
    table : DataFrame
    cost, error : str
        Names of columns; a row without an error is not on the front.
    """
    rising = table[table[error].notna()].sort_values([cost, error], kind="stable")
    best = rising[error].cummin().shift(fill_value=np.inf)
    return rising[rising[error] < best]
