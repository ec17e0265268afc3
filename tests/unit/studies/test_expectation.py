# SPDX-License-Identifier: GPL-3.0-or-later
"""What to expect of a bed, as rows of the audit and lines of the estimate; other regimes are named there."""

from dataclasses import replace

import pytest

from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from bedchain.studies.expectation import audit_rows, expected_of, lines
from made import ROOT


@pytest.fixture(scope="module")
def scene():
    return scene_of(load_case(ROOT / "cases" / "paper" / "case.yaml"))


def test_the_paper_s_bed(scene):
    rows = expected_of(scene, 0.25).set_index("quantity")
    assert (rows["regime"] == "slow bubbles").all()
    assert rows.loc["share below 0.25 m", "value"] == pytest.approx(0.639, abs=6e-4)
    text = lines(expected_of(scene, 0.25))
    assert "slow bubbles" in text[0] and "  mean particle height: 0.196 m" in text
    assert (audit_rows(expected_of(scene, 0.25))["decision"] == "expect").all()


def test_outside_its_range_the_table_says_which_regime_it_is(scene):
    rows = expected_of(replace(scene, velocity=0.5), 0.25)
    assert rows["regime"].tolist() == ["fixed bed"] and rows["value"].isna().all()
    assert audit_rows(rows)["physics"].tolist() == ["expected of the bed: fixed bed"]
    assert "regime, fixed bed: the gas has 0.5 m/s, u_mf is 0.756 m/s" in lines(rows)[0]


def test_without_gas_nothing_is_expected(scene):
    rows = expected_of(replace(scene, gas=False), 0.25)
    assert rows.empty and lines(rows) == [] and audit_rows(rows).empty
