# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of a made-up two-fluid run: a roll that turns in a bed of even density."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.dem.two_fluid import Run
from bedchain.dem.two_fluid_balance import COLUMNS
from bedchain.dem.two_fluid_fields import Flow
from bedchain.errors import UserError
from bedchain.studies.two_fluid_summary import read_summary, summarise, write_summary
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
    times = 0.005 * np.arange(1, 301)
    return pd.DataFrame(
        {
            "time_s": times,
            "pressure_drop_Pa": 1200 + 50 * np.sin(2 * np.pi * 5 * times),
            "solids_drift_1": -2e-6 * times / 1.5,
        }
    )


def balance(frames=60):
    table = pd.DataFrame(0.0, index=range(frames), columns=COLUMNS)
    table["time_s"] = 0.025 * np.arange(1, frames + 1)
    return table.assign(weight_Pa=1000.0, gas_pressure_Pa=900.0, solids_pressure_Pa=70.0)


def test_series_profile_and_curves_of_a_roll(case, roll, tmp_path):
    summary = summarise(Run(roll, pressure(), balance(), 12.0), case)
    np.testing.assert_allclose(summary.series["mean_height_m"], 0.08)
    np.testing.assert_allclose(summary.series["share_low_1"], 0.5)
    np.testing.assert_allclose(summary.profile["voidage_1"], [0.6] * 8 + [1.0] * 12)
    assert summary.density["share_1"].sum() == pytest.approx(1)
    assert summary.record["pressure_frequency_Hz"] == pytest.approx(5.0)
    assert summary.record["pressure_frequency_resolution_Hz"] == pytest.approx(5.0)
    assert summary.record["carries_weight_1"]["rest"] == pytest.approx(0.03)
    assert summary.record["largest_drift_1"] == pytest.approx(2e-6) and summary.record["cpu_s_per_s"] == 12.0
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
        summarise(Run(roll, pressure(), balance(), 12.0), case)


def test_a_summary_without_a_balance_is_read_too(case, roll, tmp_path):
    summary = summarise(Run(roll, pressure(), balance(0), 12.0), case)
    assert "carries_weight_1" not in summary.record
    write_summary(summary, tmp_path)
    (tmp_path / "balance.csv").unlink()
    assert list(read_summary(tmp_path).balance) == COLUMNS
