# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the comparison, by hand."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.metrics import (
    batch_metrics,
    bed_metrics,
    floor_metrics,
    mean_metric,
    model_metrics,
    noise_metrics,
    report_metrics,
)
from bedchain.errors import UserError

DEM = np.array([[1.0, 1.0, 1.0, 1.0], [0.5, 0.6, 0.7, 0.8]])
MODEL = np.array([[1.0, 1.0, 1.0, 1.0], [0.7, 0.4, 0.7, 0.8]])


def by_quantity(rows):
    return {row["quantity"]: row for row in rows}


def test_bands_come_from_chains_without_a_block():
    shifts = np.linspace(-0.02, 0.02, 5)
    left_out = MODEL + shifts[:, None, None]
    row = by_quantity(model_metrics("static", MODEL, DEM, left_out))["error_signed_left"]
    half = 2.776445 * np.sqrt(0.8 * (shifts**2).sum())
    assert (row["source"], row["unit"]) == ("static", "1")
    assert [row["value"], row["ci_low"], row["ci_high"]] == pytest.approx([0.2, 0.2 - half, 0.2 + half])
    assert np.isnan(by_quantity(model_metrics("static", MODEL, DEM))["error_signed_left"]["ci_low"])


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
    rng, widths = np.random.default_rng(4), []
    for _ in range(40):
        independent, held = rng.normal(10, 1, 2000), np.repeat(rng.normal(10, 1, 100), 20)
        rows = [mean_metric("a", series, "Pa") for series in (independent, held)]
        widths.append([row["ci_high"] - row["ci_low"] for row in rows])
    # twice 2.78 standard errors, 1 / sqrt(2000) and 1 / sqrt(100), of which five blocks know 0.94 on average
    expected = 2 * 2.776 * 0.94 / np.sqrt([2000, 100])
    assert np.mean(widths, axis=0) == pytest.approx(expected, rel=0.2)


def test_mean_of_a_series_too_short_has_no_band():
    row = mean_metric("a", np.sin(np.linspace(0, 3, 100)), "Pa")
    assert np.isnan(row["ci_low"]) and np.isfinite(row["value"])


def test_window_outside_the_series_is_refused():
    series = pd.DataFrame({"time_s": [0.0, 1.0]})
    with pytest.raises(UserError, match="no time from 3 s to 5 s"):
        bed_metrics(series, 800.0, 3.0, 5.0)


def of_all_groups(rows):
    """(n_realisations, n_times, 4) of (n_realisations, n_times): the same in each group."""
    return np.repeat(np.array(rows, float)[:, :, None], 4, axis=2)


def values(rows):
    return {row["quantity"]: row["value"] for row in rows}


def test_a_chain_that_is_the_mean_has_the_floor_as_its_error():
    rng = np.random.default_rng(5)
    curves = 0.5 + rng.normal(0, 0.05, (100, 2000, 4))
    metrics = values(noise_metrics("static", np.full((2000, 4), 0.5), curves))
    for group in ("left", "right", "low", "up"):
        # the rms of 2000 draws is known to 1.6 %
        assert metrics[f"error_over_noise_{group}"] == pytest.approx(1, abs=0.05)
        # the mean of 100 realisations is off by a tenth of the noise
        assert metrics[f"error_rms_of_mean_{group}"] == pytest.approx(0.005, rel=0.1)
    assert metrics["error_over_noise_mixing"] == pytest.approx(1, abs=0.02)
    another = values(noise_metrics("static", curves[0], curves))["error_over_noise_mixing"]
    assert another == pytest.approx(2**0.5, abs=0.05)
    off = values(noise_metrics("static", np.full((2000, 4), 0.6), curves))
    assert off["error_signed_of_mean_left"] == pytest.approx(0.1, abs=0.005)
    assert off["error_over_noise_left"] > 2


def test_equal_realisations_give_a_floor_of_nothing_and_no_ratio():
    curves = of_all_groups([[1, 0.8, 0.6]] * 3)
    assert values(floor_metrics(curves))["noise_floor_left"] == pytest.approx(0, abs=1e-15)
    equal = values(noise_metrics("static", curves[0], curves))
    assert not {"error_over_noise_left", "error_over_noise_mixing"} & equal.keys()
