# SPDX-License-Identifier: GPL-3.0-or-later
"""Many random cases taken through the stages on made frames: no stage ends in a traceback."""

from hypothesis import given, settings

from made.random_cases import case_files, try_out


@settings(max_examples=300)
@given(case_files())
def test_a_random_case_ends_in_results_or_in_a_sentence(content):
    try_out(content)
