# SPDX-License-Identifier: GPL-3.0-or-later
"""The onset of fluidization read from a made-up ramp, and the balance on its plateau."""

import numpy as np
import pandas as pd
import pytest

from bedchain.studies.verification import fluidization
from bedchain.studies.verification.laws import Suspension, ergun_gradient, minimum_fluidization

OF = Suspension(fluidization.DIAMETER, 2600.0, 1.2, 1.8e-5)
E, HEIGHT = 0.42, 0.05
WEIGHT = (1 - E) * 2598.8 * 9.81 * HEIGHT


def ramp():
    """Pressure drop of a bed that obeys Ergun until its weight is carried."""
    times = np.linspace(0, fluidization.RAMP, 400)
    speed = times / fluidization.RAMP * fluidization.FASTEST
    drop = np.minimum([ergun_gradient(OF, E, u) * HEIGHT for u in speed], WEIGHT)
    return pd.DataFrame({"time_s": times, "inlet_velocity_m_s": speed, "pressure_drop_Pa": drop})


def test_the_onset_of_ergun_s_own_curve_is_his():
    onset = minimum_fluidization(OF, E)
    # a guess that is off by a tenth finds it too
    for guess in (onset, 0.9 * onset, 1.1 * onset):
        fitted, error = fluidization.fitted_onset(ramp(), fluidization.UP, WEIGHT, guess)
        assert fitted == pytest.approx(onset, rel=1e-6) and error < 1e-6 * onset
    looser = ramp().assign(pressure_drop_Pa=lambda table: 0.9 * table["pressure_drop_Pa"])
    assert fluidization.fitted_onset(looser, fluidization.UP, WEIGHT, onset)[0] > 1.03 * onset


def test_the_error_of_a_fitted_onset_is_at_most_twice_the_scatter_of_many():
    onset, rng = minimum_fluidization(OF, E), np.random.default_rng(3)
    clean = ramp()
    noise = 0.02 * WEIGHT * rng.normal(size=(200, len(clean)))
    fits = [
        fluidization.fitted_onset(
            clean.assign(pressure_drop_Pa=clean["pressure_drop_Pa"] + each), fluidization.UP, WEIGHT, onset
        )
        for each in noise
    ]
    values, errors = np.array(fits).T
    assert 1 < np.sqrt((errors**2).mean()) / values.std() < 2


def test_the_theory_of_a_ramp_is_ergun_up_to_the_weight():
    curve = fluidization.curve_of("up", ramp(), fluidization.UP, OF, E)
    area = fluidization.WIDTH * fluidization.DIAMETER
    weight = fluidization.NUMBER * OF.weight / area
    height = fluidization.NUMBER * OF.volume / (area * (1 - E))
    assert curve.reference[-1] == pytest.approx(weight) and (np.diff(curve.reference) >= 0).all()
    assert curve.reference[50] == pytest.approx(ergun_gradient(OF, E, curve.x[50]) * height)


def test_the_plateau_allows_for_walls_and_for_a_bed_that_slows_down():
    times = np.linspace(fluidization.RAMP, fluidization.RAMP + fluidization.HOLD, 50)
    # the bed's rise slows by 0.5 m/s2: the gas carries 5 % less
    late = times - fluidization.RAMP
    table = pd.DataFrame(
        {
            "time_s": times, "mean_height_m": 0.03 + 0.2 * late - 0.25 * late**2,
            "weight_on_floor_1": 0.02, "weight_on_sides_1": 0.01,
            "pressure_drop_Pa": WEIGHT * (1 - 0.03 - 0.5 / 9.81 + 0.01 * np.sin(200 * late)),
        }
    )  # fmt: skip
    row = fluidization.plateau(table, WEIGHT)
    assert row.value == pytest.approx(1.0, abs=3e-3) and row.passed
    assert 1e-4 < row.error < 0.01
    assert not fluidization.plateau(table.assign(weight_on_floor_1=0.06), WEIGHT).passed
