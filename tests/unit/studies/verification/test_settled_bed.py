# SPDX-License-Identifier: GPL-3.0-or-later
"""Ergun's pressure drop over rows, and fields of the gas by rows."""

import numpy as np
import pytest

from bedchain.dem.gas_field import GasField
from bedchain.dem.lattices import lattice
from bedchain.studies.verification import settled_bed
from bedchain.studies.verification.laws import Suspension, ergun_gradient

OF = Suspension(settled_bed.DIAMETER, 2600.0, 1.2, 1.8e-5)


def test_the_drop_over_a_lattice_is_that_of_its_voidage_over_its_height():
    z = lattice(settled_bed.WIDTH, 0.05, settled_bed.DIAMETER, settled_bed.DIAMETER)[:, 1]
    edges = np.linspace(0, 0.1, 21)  # the upper half is empty: there it is that of the gas alone, nothing
    expected = ergun_gradient(OF, 1 - np.pi / 6, 0.5) * 0.05
    assert settled_bed.expected_drop(OF, z, edges, 0.5) == pytest.approx(expected)


def test_rows_of_a_field_go_up_and_columns_right(monkeypatch):
    x, z = np.array([0.02, 0.01, 0.01, 0.02]), np.array([0.03, 0.03, 0.01, 0.01])
    values = np.stack([x, z], axis=1)
    monkeypatch.setattr(settled_bed, "read_gas_field", lambda case, name: GasField(0.0, x, z, values, None))
    rows = settled_bed.rows_of(None, "U")
    assert rows.shape == (2, 2, 2)
    assert rows[0].tolist() == [[0.01, 0.01], [0.02, 0.01]] and rows[1, :, 0].tolist() == [0.01, 0.02]
