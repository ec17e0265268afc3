# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of the settings."""

import itertools

import pandas as pd

from bedchain.studies.stability.bed_settings import bed_settings
from bedchain.studies.stability.chain_settings import chain_settings
from bedchain.studies.stability.maps import draw_maps
from bedchain.studies.stability.study import row_of
from bedchain.studies.stability.verdict import (
    DIVERGED,
    INACCURATE,
    REFUSED,
    STABLE,
    Verdict,
)


def test_maps_are_drawn_of_whatever_was_tried(tmp_path):
    outcomes = itertools.cycle([STABLE, INACCURATE, REFUSED, DIVERGED])
    # of each group a few: all of them take half a minute to draw
    groups = itertools.groupby([*chain_settings(), *bed_settings()], key=lambda item: item.group)
    settings = [item for _, items in groups for item in itertools.islice(items, 3)]
    rows = [row_of(item, Verdict(next(outcomes)), 1.0) for item in settings]
    draw_maps(pd.DataFrame(rows), tmp_path)
    files = {file.name for file in tmp_path.iterdir()}
    assert files == {f"{name}{form}" for name in ("steps", "gas_steps", "others", "chains")
                     for form in (".png", ".pdf", ".csv")}  # fmt: skip
    draw_maps(pd.DataFrame(rows[:5]), tmp_path / "some")
    assert {file.stem for file in (tmp_path / "some").iterdir()} == {"chains"}
