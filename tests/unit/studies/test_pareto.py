# SPDX-License-Identifier: GPL-3.0-or-later
"""The Pareto front, against a loop over all pairs."""

import numpy as np
import pandas as pd

from bedchain.studies.pareto import pareto_front


def test_the_front_is_what_no_other_row_beats():
    rng = np.random.default_rng(1)
    for _ in range(20):
        # few values: many rows cost or err the same
        table = pd.DataFrame(rng.integers(0, 6, (15, 2)).astype(float), columns=["cost", "error"])
        table.loc[rng.integers(15), "error"] = np.nan
        known = table.dropna().to_numpy().tolist()
        beaten = [
            any(c <= cost and e <= error and (c, e) != (cost, error) for c, e in known)
            for cost, error in known
        ]
        expected = sorted({tuple(row) for row, worse in zip(known, beaten, strict=True) if not worse})
        front = pareto_front(table, "cost", "error")
        assert [tuple(row) for row in front.to_numpy()] == expected
