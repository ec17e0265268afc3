# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of the trade-off study, and errors of them in noise floors."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from bedchain.measures.batch import total_variation
from bedchain.studies.tradeoff.observables import (
    BedObservables,
    Reference,
    curve_errors,
    density_errors,
    scalar_errors,
)
from bedchain.uncertainty.noise_floor import noise_floor
from made.realisations import realisations


def test_curve_errors_are_those_of_a_loop_in_noise_floors():
    found = realisations()
    model = np.full((30, 4), 0.47)
    row = curve_errors(found, model[None, None])
    floor = noise_floor(found.curves)[0]
    for column, name in enumerate(("left", "right", "low", "up")):
        total = [np.mean((model[:, column] - one[:, column]) ** 2) for one in found.curves]
        error = np.sqrt(np.mean(total))
        assert row[f"{name}_error_1"] == pytest.approx(error)
        assert row[f"{name}_floors_1"] == pytest.approx(error / floor[column])
        assert row[f"{name}_ci_low_1"] <= error <= row[f"{name}_ci_high_1"]
    whole = np.sqrt(np.mean((model - found.curves) ** 2) / np.mean(floor**2))
    assert row["mixing_floors_1"] == pytest.approx(whole)


def test_the_mean_of_all_realisations_has_one_floor_and_another_bed_sqrt_two():
    many = realisations(number=60)
    exact = curve_errors(many, many.curves.mean(axis=0)[None, None])
    # the floor has 59 in its denominator where the error has 60
    assert exact["mixing_floors_1"] == pytest.approx(np.sqrt(59 / 60), rel=1e-9)
    draws = np.stack([realisations(1, seed=seed).curves for seed in range(10, 30)])
    assert curve_errors(many, draws)["mixing_floors_1"] == pytest.approx(np.sqrt(2), rel=0.02)


def test_without_repeats_there_is_an_error_and_no_floor():
    found = realisations()
    alone = Reference(found.curves, False, found.densities[:1], {"bed_height": (0.06,)})
    row = curve_errors(alone, np.full((1, 1, 30, 4), 0.47))
    assert row["mixing_error_1"] > 0 and np.isnan(row["mixing_floors_1"])
    assert np.isfinite(row["mixing_ci_low_1"])  # over starts
    height = scalar_errors(alone, {"bed_height": 0.061})
    assert height["bed_height_error_m"] == pytest.approx(1e-3)
    assert np.isnan(height["bed_height_floors_1"]) and np.isnan(height["bed_height_ci_low_m"])


def test_further_realisations_join_the_reference():
    whole = realisations(number=6)
    first = Reference(
        whole.curves[:4], True, whole.densities[:4], {"bed_height": whole.scalars["bed_height"][:4]}
    )
    others = [
        BedObservables(whole.curves[at], whole.densities[at], {"bed_height": whole.scalars["bed_height"][at]})
        for at in (4, 5)
    ]
    joined = first.joined(others)
    assert joined.floors() == pytest.approx(whole.floors(), nan_ok=True)
    assert first.joined([]) is first
    # curves of several starts are no realisations
    alone = replace(first, repeated=False).joined(others)
    assert len(alone.curves) == 4 and len(alone.densities) == 6


def test_densities_are_compared_half_by_half():
    found = realisations(number=3)
    row = density_errors(found, found.densities[:1])
    wanted = [
        total_variation(found.densities[0, half], found.densities[run, half])
        for run in range(3)
        for half in range(2)
    ]
    assert row["density_error_1"] == pytest.approx(np.mean(wanted))
    others = [
        total_variation(found.densities[run, half], np.delete(found.densities[:, half], run, 0).mean(axis=0))
        for run in range(3)
        for half in range(2)
    ]
    assert row["density_floors_1"] == pytest.approx(np.mean(wanted) / np.mean(others))


def test_scalars_have_students_interval_of_one_more_realisation():
    found = realisations()
    values = np.array(found.scalars["bed_height"])
    row = scalar_errors(found, {"bed_height": 0.07, "unknown": 1.0})
    half = stats.t.ppf(0.975, 3) * values.std(ddof=1) * np.sqrt(1.25)
    assert row["bed_height_error_m"] == pytest.approx(0.07 - values.mean())
    assert row["bed_height_ci_high_m"] - row["bed_height_ci_low_m"] == pytest.approx(2 * half)
    assert not [name for name in row if name.startswith(("unknown", "pressure"))]
