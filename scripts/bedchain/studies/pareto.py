# SPDX-License-Identifier: GPL-3.0-or-later
"""What nothing else beats in both cost and error."""

import numpy as np
import pandas as pd


def pareto_front(table: pd.DataFrame, cost: str, error: str) -> pd.DataFrame:
    """Rows that no other is both cheaper and more accurate than, by rising cost and so falling error.

    Parameters
    ----------
    table : DataFrame
    cost, error : str
        Columns; a row without an error is on no front.
    """
    rising = table[table[error].notna()].sort_values([cost, error], kind="stable")
    best = rising[error].cummin().shift(fill_value=np.inf)
    return rising[rising[error] < best]
