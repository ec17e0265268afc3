# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of a mixture: separated, even, and by hand."""

import numpy as np
import pytest

from bedchain.chains.networks.mixture import (
    composition,
    limit_of,
    mixture_measures,
    mixture_metrics,
    mixture_table,
    mixtures_table,
)
from bedchain.errors import UserError


def test_separated_and_even_mixtures():
    key, total = np.array([1.0, 0.0]), np.array([1.0, 1.0])
    assert mixture_measures(key, total, np.ones(2), 1000) == pytest.approx((0.25, 0.25, 1.0, 0.0))
    even = mixture_measures(total / 2, total, np.ones(2), 1000)
    assert even[:3] == (0, 0, 0) and even[3] == pytest.approx(1 / (1 - 1 / 1000))


def test_compositions_are_weighted_by_capacity_and_empty_states_do_not_count():
    key, total, volume = np.array([3.0, 0.0, 0.0]), np.array([3.0, 1.0, 0.0]), np.array([3.0, 1.0, 5.0])
    assert mixture_measures(key, total, volume, 1000)[1] == pytest.approx(0.75 * 0.25)
    np.testing.assert_array_equal(composition(key, total), [1, 0, np.nan])


def test_variances_of_a_table_are_over_those_of_the_start():
    key = np.array([[1.0, 0.0], [0.75, 0.25]])
    table = mixture_table(key, np.ones((2, 2)), np.ones(2), 1000, np.array([0.0, 2.0]))
    curve = table[table["quantity"] == "content_variance"]
    assert curve["value"].tolist() == [1, 0.25] and curve["time_s"].tolist() == [0, 2]


def test_mixture_has_its_best_revolution_below_the_limit(mixers):
    mixture = {"name": "m", "key": "a", "others": ["b"], "revolutions": 8, "particles": 100.0}
    table = mixtures_table(mixture, mixers, "x")
    limit = limit_of(mixers["a"])
    numbers = mixture_metrics(table, limit).set_index("quantity")["value"]
    assert numbers["best_revolutions"] == 5 and numbers["content_variance_5"] < limit == pytest.approx(
        0.029252, abs=1e-6
    )


def test_an_overfull_mixture_names_file_and_mixture(mixers):
    full = {name: chain._replace(start=2 * chain.start) for name, chain in mixers.items()}
    mixture = {"name": "m", "key": "a", "others": ["b"], "revolutions": 8, "particles": 100.0}
    with pytest.raises(UserError, match="x, mixture m: column 1 row . holds"):
        mixtures_table(mixture, full, "x")
