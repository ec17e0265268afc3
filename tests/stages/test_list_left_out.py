# SPDX-License-Identifier: GPL-3.0-or-later
"""What is left out, and why: of frames, of cells that are no flat boxes, of an open bed."""

import pandas as pd
import pytest

from bedchain.chains.registry import CaseChains
from bedchain.errors import DataError
from list_left_out import OF_GROUPS, Cells, list_left_out

OF_STUDIES = "discussion.csv, fig_discussion; targets scores and tradeoff"


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        (Cells("boxes", 1, "refuse"), None),
        (Cells("boxes", 2, "refuse"), "the cells are boxes in layers"),
        (Cells("sectors", 1, "refuse"), "the cells are sectors"),
        (Cells("boxes", 1, "exit"), "particles may leave this one"),
    ],
)
@pytest.mark.parametrize("imported", [True, False])
def test_each_product_that_is_missing_has_its_reason(bed, tmp_path, cells, reason, imported):
    list_left_out(bed.files, tmp_path / "left_out.csv", cells, imported, track=imported)
    reasons = pd.read_csv(tmp_path / "left_out.csv").set_index("product")["reason"]
    assert ("no gas in the frames" in set(reasons)) == imported
    expected = (
        "no groups that mix" if imported else "which leave the bed" if cells.outside == "exit" else None
    )
    assert expected is None or expected in reasons[OF_GROUPS]
    assert (OF_STUDIES in reasons) == (reason is not None)
    chains = CaseChains(4, 5, 0.1, "pooled", layers=cells.layers, form=cells.form, outside=cells.outside)
    if reason is None:
        assert chains.flat_grid(0.1, 0.2).n_cells == 20
    else:
        assert reason in reasons[OF_STUDIES]
        with pytest.raises(DataError, match=reason):
            chains.flat_grid(0.1, 0.2)
