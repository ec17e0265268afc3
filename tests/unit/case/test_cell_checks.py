# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of every form: what does not go with the bed or with a chain is refused, the rest is taken."""

import pytest

from bedchain.case.load import load_case
from made.case_text import assert_refused, changed_case

CUBE = ("height_m: 0.45", "height_m: 0.45\n  thickness_m: 0.09\n  layers: many")
MISTAKES = [
    # after the rows of the cells, key named, in the message
    ("layers: 91", "cells.layers", "take at most 90"),
    ("form: rings", "cells.columns", "take at most 45"),
    ("form: sectors\n  layers: 46", "cells.layers", "take at most 45"),
    ("form: rings\n  layers: 2", "cells.layers", "they have columns and rows only"),
    ("form: sectors\n  axis: horizontal", "cells.form", "0.09 m wide, with bed.height_m 0.45 m"),
    ("layers: 5\nchain: {models: [static, jump]}", "chain.models", "jump knows places along x and z only"),
    ("form: hexagons", "cells.form", "boxes, rings, sectors"),
]


@pytest.mark.parametrize(("lines", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, lines, key, message):
    columns = ("columns: 10", "columns: 46" if "rings\n" not in lines and "rings" in lines else "columns: 10")
    case = changed_case(tmp_path, CUBE, columns, ("rows: 50", f"rows: 50\n  {lines}"))
    assert_refused(case, key, message)


@pytest.mark.parametrize("lines", ["layers: 3", "form: rings", "form: sectors\n  layers: 4"])
def test_cells_in_three_dimensions_are_taken(tmp_path, lines):
    case = load_case(changed_case(tmp_path, CUBE, ("rows: 50", f"rows: 50\n  {lines}")))
    assert len(case["cells"]) > 2


def test_a_flat_bed_has_no_upright_rings(tmp_path):
    assert_refused(
        changed_case(tmp_path, ("rows: 50", "rows: 50\n  form: rings")),
        "cells.form",
        "with bed.thickness_m 0.001 m",
    )
