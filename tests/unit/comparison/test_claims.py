# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims against measured numbers: within, off, not measured; and the numbers that only claims ask for."""

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.claims import agreement, cost_metrics, read_claims, swing_metrics
from bedchain.comparison.curves import curve_table
from bedchain.comparison.metrics import metric
from bedchain.errors import UserError
from made import ROOT

CLAIMS = """\
claim,where,quantity,source,value,tolerance,unit,why
half is left,section 3,share,dem,0.5,0.1,1,a moment
80 times cheaper,section 3,ratio,static,80,40,1,another code
"""


@pytest.fixture
def claims(tmp_path):
    file = tmp_path / "claims.csv"
    file.write_text(CLAIMS)
    return file


def test_claims_hold_or_not_and_say_why(claims):
    measured = pd.DataFrame([metric("share", "dem", 0.59), metric("ratio", "static", 4000.0)])
    table = agreement(read_claims(claims), measured)
    assert table["within"].tolist() == ["yes", "no"]
    assert table["paper"].tolist() == [0.5, 80] and table["ours"].tolist() == [0.59, 4000]
    assert table["why"].tolist() == ["a moment", "another code"]


def test_what_was_not_measured_or_in_another_unit_is_an_error(claims):
    measured = pd.DataFrame([metric("share", "dem", 0.5), metric("ratio", "static", 80.0, "s")])
    with pytest.raises(UserError, match="80 times cheaper.*no ratio of static in 1"):
        agreement(read_claims(claims), measured)


def test_a_claim_needs_a_reason(claims):
    claims.write_text(CLAIMS.replace(",a moment", ","))
    with pytest.raises(UserError, match="each claim needs why"):
        read_claims(claims)


def test_swings_by_hand():
    times = np.array([0.0, 0.1, 0.2, 0.3])
    zigzag = np.repeat(np.array([1.0, 0.5, 0.8, 0.6])[:, None], 4, axis=1)
    smooth = np.repeat(np.array([1.0, 0.7])[:, None], 4, axis=1)
    table = pd.concat([curve_table(times, "dem", zigzag), curve_table(times[::2], "static", smooth)])
    ratios = {row["quantity"]: row["value"] for row in swing_metrics(table)}
    # at the chain's own times the DEM goes down by 0.2
    assert ratios == {
        f"swings_over_dem_{name}": pytest.approx(1.5) for name in ("left", "right", "low", "up")
    }


def test_costs_by_hand():
    stages = ["dem", "static_count", "static_matrix", "static_monte_carlo"]
    stages += ["dynamic_count", "dynamic_matrix", "dynamic_monte_carlo"]
    timing = pd.DataFrame({"stage": stages, "wall_s": [7200.0, 1.0, 1.0, 2.0, 9.0, 11.0, 4.0]})
    costs = {
        (row["quantity"], row["source"]): row["value"] for row in cost_metrics(timing, ["static", "dynamic"])
    }
    assert costs == {
        ("dem_time", "dem"): 2.0,
        ("dem_over_chain_time", "static"): 1800.0,
        ("dem_over_chain_time", "dynamic"): 300.0,
        ("dynamic_over_static_time", "dynamic"): 10.0,
    }


def test_claims_of_the_paper_can_be_read():
    table = read_claims(ROOT / "cases" / "paper" / "claims.csv")
    assert len(table) > 15 and set(table["source"]) == {"dem", "static", "dynamic"}
