# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranks by what the machine's load leaves free."""

import os

import pytest

from bedchain.dem.free_ranks import ranks_of


@pytest.mark.parametrize(("load", "ranks"), [(0.1, 6), (2.0, 6), (4.9, 3), (7.4, 1), (30.0, 1)])
def test_auto_takes_free_cores_that_share_the_gas_cells(monkeypatch, load, ranks):
    monkeypatch.setattr(os, "getloadavg", lambda: (load, 0.0, 0.0))
    monkeypatch.setattr(os, "cpu_count", lambda: 8)
    assert ranks_of("auto", 8, {"gas_cells_x": 18.0}) == ranks


def test_a_number_is_taken_as_it_is():
    assert ranks_of("5", 2, {}) == 5
