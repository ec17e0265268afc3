# SPDX-License-Identifier: GPL-3.0-or-later
"""Drift and dispersion of layers, against a loop."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.measures.dispersion import dispersion_by_height, layer_of
from bedchain.trajectory.frames import Lag

EDGES = np.array([0.0, 0.4, 1.0])


def test_layers_are_those_of_a_loop():
    rng = np.random.default_rng(1)
    x, z = rng.random((2, 6, 50)) * [[[1.0]], [[1.2]]]
    layers = dispersion_by_height(x, z, EDGES, Lag(2, 0.05))
    for layer in range(2):
        moves = np.array(
            [
                (x[f + 2, p] - x[f, p], z[f + 2, p] - z[f, p])
                for f in range(4)
                for p in range(50)
                if EDGES[layer] <= z[f, p] < EDGES[layer + 1]
            ]
        )
        assert layers.displacements[layer] == len(moves) < 200
        assert layers.drift_m_s[layer] == pytest.approx(moves.mean(axis=0) / 0.05)
        assert layers.dispersion_m2_s[layer] == pytest.approx(moves.var(axis=0) / 0.1)
    assert layers.height_m.tolist() == [0.2, 0.7]


def test_a_layer_without_particles_has_no_number():
    layers = dispersion_by_height(np.zeros((3, 2)), np.full((3, 2), 0.5), EDGES, Lag(1, 0.1))
    assert layers.displacements.tolist() == [0, 4]
    assert np.isnan(layers.drift_m_s[0]).all() and (layers.drift_m_s[1] == 0).all()


def test_a_lag_as_long_as_the_frames_is_refused():
    with pytest.raises(DataError, match="3 frames hold no displacement over 3 frames"):
        dispersion_by_height(np.zeros((3, 2)), np.zeros((3, 2)), EDGES, Lag(3, 0.1))


def test_layers_are_those_of_digitize():
    z = np.random.default_rng(3).uniform(-0.2, 1.2, 2000).astype(np.float32).astype(float)
    for edges in (np.linspace(0, 1, 8), np.arange(6) * 0.1, np.array([0.0, 0.1, 0.5, 0.6])):
        places = np.concatenate((z, edges))
        assert (layer_of(places, edges) == np.digitize(places, edges)).all()
