# SPDX-License-Identifier: GPL-3.0-or-later
"""Composition of a mixture whose components move by chains of their own on the same states."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains.networks import checks
from bedchain.chains.networks.mixer import check_filling
from bedchain.chains.networks.outputs import ROUND_OFF, Row
from bedchain.chains.networks.page import PageChain
from bedchain.errors import UserError
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


def mixtures_table(mixture: Mapping[str, Any], chains: Mapping[str, PageChain], place: str) -> pd.DataFrame:
    """A mixture over the cycles of its chains: mixture, quantity, revolution, time_s, value.

    Parameters
    ----------
    mixture : mapping
        Of a page: name, key, others, revolutions, particles.
    chains : mapping of str to PageChain
    place : str
        The case's file, for messages.

    Raises
    ------
    UserError
        A state holds more than its capacity.
    """
    key = chains[mixture["key"]]
    cycle, network = len(key.network.cycle), key.network
    steps = cycle * mixture["revolutions"]
    contents = {
        name: chains[name].network.expected(checks.start_of(chains[name]), steps)
        for name in [mixture["key"], *mixture["others"]]
    }
    total = np.sum(list(contents.values()), axis=0)
    capacity = network.contents
    try:
        check_filling(total / capacity, network.names)
    except UserError as error:
        raise UserError(f"{place}, mixture {mixture['name']}: {error}") from None
    times = network.step_s * cycle * np.arange(mixture["revolutions"] + 1)
    table = mixture_table(
        contents[mixture["key"]][::cycle], total[::cycle], capacity, mixture["particles"], times
    )
    table.insert(0, "mixture", mixture["name"])
    return table


def mixture_metrics(table: pd.DataFrame, limit: float) -> pd.DataFrame:
    """Numbers of a mixture: its variances over that of the start, their limit, and the best revolution."""
    name = str(table["mixture"].iloc[0])
    rows = [
        Row(f"{row.quantity}_{row.revolution}", row.value, "1")
        for row in table[table["quantity"].isin(["content_variance", "lacey_index"])].itertuples()
    ]
    curve = table[table["quantity"] == "content_variance"].set_index("revolution")["value"]
    rows.append(Row("content_variance_limit", limit, "1"))
    rows.append(Row("best_revolutions", float(curve[curve <= curve.min() * (1 + ROUND_OFF)].index[0]), "1"))
    metrics = pd.DataFrame(rows)
    metrics.insert(1, "source", name)
    return metrics.assign(ci_low=np.nan, ci_high=np.nan)


def limit_of(chain: PageChain) -> float:
    """Variance of a closed chain's content in the long run over that of its start [1]."""
    start, volume = checks.start_of(chain), chain.network.contents
    filled = [contents / volume for contents in (chain.network.long_run(start), start)]
    weight = volume / volume.sum()
    last, first = (float(weight @ (values - weight @ values) ** 2) for values in filled)
    return last / first
