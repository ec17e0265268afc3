# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed of the trade-off study: realisations of it, and its own chain."""

import numpy as np

from bedchain.studies.tradeoff.chain_settings import CaseChain
from bedchain.studies.tradeoff.observables import Reference
from bedchain.trajectory.grid import Grid


def realisations(number=4, frames=30, cells=12, seed=3):
    """A reference of made-up curves, densities and heights."""
    rng = np.random.default_rng(seed)
    curves = 0.5 + rng.normal(0, 0.05, (number, frames, 4))
    densities = rng.dirichlet(np.full(cells, 5.0), (number, 2))
    scalars = {"bed_height": tuple(rng.normal(0.06, 1e-3, number))}
    return Reference(curves, number > 1, densities, scalars)


def own(columns=10, rows=40, width=0.1, height=0.4, frames=80, **changes):
    """The short bed's own chain, or another."""
    values = {
        "lag": 1, "estimator": "pooled", "learning": slice(60, 60 + frames + 1), "compared": frames,
        "interval_s": 0.025, "diameter_m": 1e-3, "splits": (width / 2, round(0.2 * height, 6)),
    }  # fmt: skip
    return CaseChain(Grid(width, height, columns, rows), **values | changes)
