# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the comparison, by hand."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.curves import curve_errors, curve_table
from bedchain.comparison.metrics import batch_metrics, bed_metrics, mean_metric, model_metrics, report_metrics
from bedchain.errors import UserError
from bedchain.measures.mixing import GROUPS

DEM = np.array([[1.0, 1.0, 1.0, 1.0], [0.5, 0.6, 0.7, 0.8]])
MODEL = np.array([[1.0, 1.0, 1.0, 1.0], [0.7, 0.4, 0.7, 0.8]])


def by_quantity(rows):
    return {row["quantity"]: row for row in rows}


def test_errors_by_hand():
    errors = curve_errors(MODEL, DEM)
    # the start, where all curves are 1, does not count
    np.testing.assert_allclose(errors["error_signed"], [0.2, -0.2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(errors["error_rms"], [0.2, 0.2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(errors["crossed_end"], [0.3, 0.6, 0.3, 0.2])


def test_bands_hold_the_middle_of_the_replicates():
    shifts = np.linspace(-0.1, 0.1, 101)
    replicates = MODEL + shifts[:, None, None]
    row = by_quantity(model_metrics("static", MODEL, DEM, replicates))["error_signed_left"]
    assert (row["source"], row["unit"]) == ("static", "1")
    assert [row["value"], row["ci_low"], row["ci_high"]] == pytest.approx([0.2, 0.105, 0.295])
    assert np.isnan(by_quantity(model_metrics("static", MODEL, DEM))["error_signed_left"]["ci_low"])


def test_curves_in_long_form():
    table = curve_table(np.array([3.0, 3.025]), "dem", DEM)
    assert list(zip(table["direction"], table["group"], strict=True)) == [g for g in GROUPS for _ in range(2)]
    assert table["fraction_remaining_1"].tolist() == DEM.T.ravel().tolist()


def test_batches_that_share_nothing_differ_by_one():
    rows = by_quantity(
        batch_metrics(
            "static",
            np.array([0.05, 0.3]),
            np.array([[1.0, 0], [0.5, 0.5]]),
            np.array([[0, 1.0], [0.5, 0.5]]),
        )
    )
    assert rows["batch_total_variation_0.05_s"]["value"] == 1
    assert rows["batch_total_variation_0.30_s"]["value"] == 0
    assert rows["batch_total_variation_mean"]["value"] == 0.5


def test_units_of_the_report_come_from_its_names():
    (row,) = report_metrics("static", json.dumps({"row_sum_error_1": 0.25}))
    assert (row["quantity"], row["unit"], row["value"]) == ("row_sum_error", "1", 0.25)


def test_mean_of_correlated_data_has_a_wide_band():
    rng = np.random.default_rng(4)
    independent = rng.normal(10, 1, 2000)
    held = np.repeat(rng.normal(10, 1, 100), 20)
    widths = [
        row["ci_high"] - row["ci_low"] for row in (mean_metric("a", x, "Pa") for x in (independent, held))
    ]
    # standard errors 1 / sqrt(2000) and 1 / sqrt(100)
    assert widths[0] == pytest.approx(4 / 2000**0.5, rel=0.4)
    assert widths[1] == pytest.approx(4 / 100**0.5, rel=0.4)


def test_window_outside_the_series_is_refused():
    series = pd.DataFrame({"time_s": [0.0, 1.0]})
    with pytest.raises(UserError, match="no time from 3 s to 5 s"):
        bed_metrics(series, 800.0, 3.0, 5.0)
