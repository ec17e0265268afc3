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
    settings = [*chain_settings(), *bed_settings()]
    rows = [row_of(item, Verdict(next(outcomes)), 1.0) for item in settings]
    draw_maps(pd.DataFrame(rows), tmp_path)
    made = {file.name for file in tmp_path.iterdir()}
    assert made == {f"{name}{form}" for name in ("steps", "gas_steps", "others", "chains")
                    for form in (".png", ".pdf", ".csv")}  # fmt: skip
    draw_maps(pd.DataFrame(rows[:5]), tmp_path / "some")
    assert {file.stem for file in (tmp_path / "some").iterdir()} == {"chains"}
