# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of made-up errors, and the manufactured voidage."""

import numpy as np
import pytest

from bedchain.studies.verification import convergence
from bedchain.studies.verification.laws import Suspension, ergun_gradient


def test_the_order_of_a_power_is_its_exponent():
    widths = 1 / np.array([8.0, 16.0, 32.0])
    assert convergence.order(3 * widths**2) == pytest.approx(2)
    assert convergence.order(0.1 * widths) == pytest.approx(1)


def test_the_lattice_is_as_dense_as_the_wave_says():
    spheres = convergence.graded_lattice()
    z = np.unique(spheres[:, 1])
    # rows of equal volume: their distance goes as one over the solids
    gaps, middles = np.diff(z), (z[1:] + z[:-1]) / 2
    dense = gaps * convergence.solids_at(middles)
    assert dense == pytest.approx(np.full(len(dense), dense.mean()), rel=0.02)
    assert spheres[:, 0].min() > 0 and spheres[:, 0].max() < convergence.WIDTH


def test_the_exact_pressure_falls_by_ergun_over_the_height_and_inertia_cancels_over_a_whole_wave():
    of = Suspension(convergence.DIAMETER, 2600.0, 1.2, 1.8e-5)
    ends = convergence.exact_pressure(of, np.array([0.0, convergence.HEIGHT]), 1.0)
    z = (np.arange(20_000) + 0.5) / 20_000 * convergence.HEIGHT
    drops = [ergun_gradient(of, 1 - solids, convergence.VELOCITY) for solids in convergence.solids_at(z)]
    assert ends[1] == 0 and ends[0] == pytest.approx(np.mean(drops) * convergence.HEIGHT, rel=1e-3)
