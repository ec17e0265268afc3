# SPDX-License-Identifier: GPL-3.0-or-later
"""Parcels that do not fit are refused with what would; cells of few parcels are warned of."""

import pytest

from bedchain.case import load
from bedchain.case.load import load_case
from made.case_text import assert_refused, changed_case

PARCEL = "parcel_diameters"
THICK = ("height_m: 0.45", "height_m: 0.45\n  layers: many\n  thickness_m: 0.012")
MISTAKES = [
    # size of a parcel, other change, key, in the message
    (3.1, (), "particles.parcel_diameters", "take at most 3"),
    (3, (THICK,), "particles.parcel_diameters", "take at most 2.4"),
    (0.5, (), "particles.parcel_diameters", "at least 1"),
    (
        3,
        (("time:", "gas:\n  cell_size_m: 3.0e-3\ntime:"),),
        "gas.cell_size_m",
        "at most 2.5",
    ),
    (2, (("time:", "contact:\n  restitution_1: 0.7\ntime:"),), "particles.parcel_diameters", "at most 1.86"),
    (2, (("columns: 10", "columns: 60"),), "cells.columns", "take at most 45"),
]


def parcels(folder, size, *changes):
    return changed_case(folder, ("number: 7200", f"number: 7200\n  {PARCEL}: {size}"), *changes)


@pytest.mark.parametrize(("size", "changes", "key", "message"), MISTAKES)
def test_parcels_that_do_not_fit_are_refused(tmp_path, size, changes, key, message):
    assert_refused(parcels(tmp_path, size, *changes), key, message)


def test_cells_of_few_parcels_are_warned_of(tmp_path, monkeypatch):
    hints = []
    monkeypatch.setattr(load, "give_hint", hints.append)
    load_case(parcels(tmp_path, 3))
    assert hints == []
    load_case(parcels(tmp_path, 3, ("columns: 10", "columns: 15")))
    assert len(hints) == 1 and "cells.columns makes 0.006 m, below 3 parcels (0.009 m)" in hints[0]
