# SPDX-License-Identifier: GPL-3.0-or-later
"""Random cases taken through the stages on made frames: no stage ends in a traceback. tests/long has more."""

import pandas as pd
from hypothesis import given, settings

from discuss_errors import CaseChains, Scanned, discuss_errors
from made.random_cases import case_files, try_out
from made.small_bed import COLUMNS, COMPARE, LEARN, ROWS, SPLITS


@settings(max_examples=15)
@given(case_files())
def test_a_random_case_ends_in_results_or_in_a_sentence(content):
    try_out(content)


def test_a_discussion_of_no_other_lag_has_the_case_s_own(bed, tmp_path):
    table = tmp_path / "discussion.csv"
    own = CaseChains(COLUMNS, ROWS, 0.025, "pooled")
    discuss_errors(bed.files, bed.mixing, table, LEARN, COMPARE, SPLITS, own, Scanned(["static"], [0.02], []))
    assert set(pd.read_csv(table)["lag_s"].dropna()) == {0.025}
