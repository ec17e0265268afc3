# SPDX-License-Identifier: GPL-3.0-or-later
"""Realisations of a bed that never was, for the trade-off study."""

import numpy as np

from bedchain.studies.tradeoff.observables import Reference


def realisations(number=4, frames=30, cells=12, seed=3):
    """A reference of made-up curves, densities and heights."""
    rng = np.random.default_rng(seed)
    curves = 0.5 + rng.normal(0, 0.05, (number, frames, 4))
    densities = rng.dirichlet(np.full(cells, 5.0), (number, 2))
    scalars = {"bed_height": tuple(rng.normal(0.06, 1e-3, number))}
    return Reference(curves, number > 1, densities, scalars)
