# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of a made-up two-fluid run: a roll that turns in a bed of even density."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.dem.two_fluid_fields import Flow
from bedchain.errors import UserError
from bedchain.studies.two_fluid_summary import read_summary, share_of_side, summarise, write_summary
from made import ROOT


@pytest.fixture
def case():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    case["gas"]["cell_size_m"] = 0.02
    case["learning"] |= {"start_s": 0.5, "end_s": 1.0}
    case["comparison"] |= {"start_s": 1.0, "end_s": 1.5}
    return case


@pytest.fixture
def roll():
    """0.4 of solids in the lower eight rows; they rise left and sink right."""
    nz, nx, frames = 20, 5, 60
    solids = np.zeros((frames, nz, nx))
    solids[:, :8] = 0.4
    right, up = np.zeros((frames, nz, nx - 1)), np.zeros((frames, nz - 1, nx))
    up[:, :7, 0], up[:, :7, -1] = 1e-7, -1e-7
    right[:, 7], right[:, 0] = 1e-7, -1e-7
    return Flow(0.025 * np.arange(1, frames + 1), solids, right, up)


def pressure():
    return pd.DataFrame(
        {"time_s": [0.5, 1.0, 1.5], "pressure_drop_Pa": 1200.0, "solids_drift_1": [0, 1e-6, -2e-6]}
    )


def test_series_profile_and_curves_of_a_roll(case, roll, tmp_path):
    summary = summarise(roll, pressure(), 12.0, case)
    np.testing.assert_allclose(summary.series["mean_height_m"], 0.08)
    np.testing.assert_allclose(summary.series["share_low_1"], 0.5)
    np.testing.assert_allclose(summary.profile["voidage_1"], [0.6] * 8 + [1.0] * 12)
    assert summary.density["share_1"].sum() == pytest.approx(1)
    assert summary.record["largest_drift_1"] == 2e-6 and summary.record["cpu_s_per_s"] == 12.0
    ends = summary.mixing.groupby(["source", "group"])["fraction_remaining_1"].last()
    # the flow never changes: its mean is as good as its frames
    np.testing.assert_allclose(ends["frames"], ends["mean_flow"], rtol=1e-5)
    assert (ends < 0.99).all()
    write_summary(summary, tmp_path / "10mm")
    again = read_summary(tmp_path / "10mm")
    np.testing.assert_allclose(
        again.mixing["fraction_remaining_1"], summary.mixing["fraction_remaining_1"], rtol=1e-6
    )
    assert again.record["window_s"] == [0.5, 1.5]


def test_a_run_that_ended_before_its_window_is_refused(case, roll):
    case["learning"]["start_s"] = 3.0
    with pytest.raises(UserError, match=r"reached 1.5 s, its window starts at 3 s"):
        summarise(roll, pressure(), 12.0, case)


def test_cells_that_a_line_cuts():
    np.testing.assert_allclose(share_of_side(4, 0.1, 0.25), [1, 1, 0.5, 0])
