# SPDX-License-Identifier: GPL-3.0-or-later
"""Composition of a mixture whose components move by chains of their own on the same states."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.measures.mixing import lacey_index

Array = NDArray[np.float64]
MEASURES = ("content_variance", "composition_variance", "coefficient_of_variation", "lacey_index")


def composition(key: Array, total: Array) -> Array:
    """Share of the key component in each state, NaN where there is nothing; shape of ``key``."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(total > 0, key / total, np.nan)


def mixture_measures(key: Array, total: Array, volume: Array, particles: float) -> tuple[float, ...]:
    """How unmixed the key component is, by `MEASURES`.

    Parameters
    ----------
    key, total : (n_states,) array
        Contents of the key component, and of all.
    volume : (n_states,) array
        Capacity of each state, the weight of its composition.
    particles : float
        Particles in a state of capacity 1: what a random mixture of them would have is taken off Lacey's
        index.

    Returns
    -------
    content_variance : float
        Variance of the key's content over capacity, weighted by capacity.
    composition_variance : float
        Variance of the composition, weighted by capacity; empty states do not count.
    coefficient_of_variation : float
        Its square root over the mean composition [1].
    lacey_index : float
        `measures.mixing.lacey_index` [1].
    """
    weight = volume / volume.sum()
    filled = key / volume
    share, held = composition(key, total), total > 0
    inner = weight[held] / weight[held].sum()
    mean = float(inner @ share[held])
    variance = float(inner @ (share[held] - mean) ** 2)
    return (
        float(weight @ (filled - weight @ filled) ** 2),
        variance,
        float(np.sqrt(variance) / mean),
        lacey_index(particles * key, particles * total),
    )


def mixture_table(key: Array, total: Array, volume: Array, particles: float, times_s: Array) -> pd.DataFrame:
    """Measures of a mixture over time, both variances over that of the start.

    Parameters
    ----------
    key, total : (n_times, n_states) array
        Contents.
    volume : (n_states,) array
    particles : float
        See `mixture_measures`.
    times_s : (n_times,) array
        [s].

    Returns
    -------
    DataFrame
        quantity, revolution (number of the time), time_s, value.
    """
    rows = np.array([mixture_measures(*now, volume, particles) for now in zip(key, total, strict=True)])
    rows[:, :2] /= rows[0, :2]
    parts = [
        pd.DataFrame(
            {"quantity": name, "revolution": np.arange(len(rows)), "time_s": times_s, "value": rows[:, at]}
        )
        for at, name in enumerate(MEASURES)
    ]
    return pd.concat(parts, ignore_index=True)
