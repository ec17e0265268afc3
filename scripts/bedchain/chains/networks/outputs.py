# SPDX-License-Identifier: GPL-3.0-or-later
"""What a network says, as tables: numbers, contents, residence times, pulses, a path."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains.networks import checks
from bedchain.chains.networks.bubbling_wakes import remaining
from bedchain.chains.networks.network import REACTED
from bedchain.chains.networks.page import PageChain

Array = NDArray[np.float64]
# F is followed until this share has left, at most so many steps
MOST_LEFT, MOST_STEPS = 0.999, 1_000_000
# rows of F and E in the table, steps of the Monte Carlo, eigenvalues
AXIAL = ("low", "up")
ROWS, DRAWN_STEPS, EIGENVALUES = 400, 400, 4
# steps of a path
MOST_PATH_STEPS = 4000
ROUND_OFF = 1e-12
# of what a closed form says
UNITS = {
    "residence_mean_continuous": "s",
    "circulation_time": "s",
    "bed_height": "m",
    "rate_closed_form": "1/s",
    "exchange_bubble_cloud": "1/s",
    "exchange_cloud_emulsion": "1/s",
    "rise_velocity": "m/s",
}
# pulses of at most so many states are numbers too
SMALL = 12
# particles that a path is chosen from
PATHS = 50


class Row(NamedTuple):
    """A number of a table of metrics."""

    quantity: str
    value: float
    unit: str


def metrics_table(chain: PageChain, particles: int, seed: int) -> pd.DataFrame:
    """Numbers of a chain: quantity, source, value, unit, ci_low, ci_high.

    Parameters
    ----------
    chain : PageChain
    particles, seed : int
        Of the Monte Carlo.
    """
    rows = [Row("row_sum_error", checks.row_sum_error(chain.network), "1")]
    rows += _open_numbers(chain) if chain.network.is_open else _closed_numbers(chain)
    steps = min(DRAWN_STEPS, horizon(chain))
    rows.append(Row("monte_carlo_sigmas", checks.monte_carlo_sigmas(chain, steps, particles, seed), "1"))
    rows += [Row(name, value, UNITS.get(name, "1")) for name, value in chain.theory.items()]
    table = pd.DataFrame(rows)
    table.insert(1, "source", chain.name)
    return table.assign(ci_low=np.nan, ci_high=np.nan)


def _open_numbers(chain: PageChain) -> Iterator[Row]:
    network, sums = chain.network, chain.network.open_chain
    mean, variance = sums.residence()
    yield Row("residence_mean", mean, "s")
    yield Row("residence_variance", variance, "s2")
    yield Row("throughput", sums.throughput / network.step_s, "1/s")
    yield Row("contents", float(sums.hold_up().sum()), "1")
    if len(network.exits) > 1:
        for name, share, moments in zip(
            network.exits, sums.exit_shares(), sums.residence_by_exit(), strict=True
        ):
            yield Row(f"exit_share_{name}", share, "1")
            yield Row(f"residence_mean_{name}", moments[0], "s")
            yield Row(f"residence_variance_{name}", moments[1], "s2")
    if network.carries:
        yield Row("hold_up_error", checks.hold_up_error(network), "1")
        yield Row("danckwerts_error", checks.danckwerts_error(network), "1")


def _closed_numbers(chain: PageChain) -> Iterator[Row]:
    network = chain.network
    values = network.modes(min(EIGENVALUES, len(network.states) - 1)).eigenvalues
    for place, value in enumerate(values, 1):
        yield Row(f"eigenvalue_{place}", float(value.real), "1")
        if abs(value.imag) > ROUND_OFF:
            yield Row(f"eigenvalue_{place}_imaginary", float(value.imag), "1")


def states_table(chain: PageChain) -> pd.DataFrame:
    """Contents of the steady state: chain, state, zone, height_m, declared, content."""
    network = chain.network
    content = network.open_chain.hold_up() if network.is_open else network.long_run(checks.start_of(chain))
    declared = network.contents if network.carries else np.nan  # those of a closed chain are capacities
    return _state_columns(chain).assign(declared=declared, content=content)


def moves_table(chain: PageChain) -> pd.DataFrame:
    """Probabilities of a step (of a cycle, of the whole of it): chain, from, to, probability_1."""
    names = np.array([*chain.network.names, *chain.network.exits])
    matrix = chain.network.product.tocoo()
    table = pd.DataFrame({"from": names[matrix.row], "to": names[matrix.col], "probability_1": matrix.data})
    table.insert(0, "chain", chain.name)
    return table


def horizon(chain: PageChain) -> int:
    """Steps after which nearly all of the feed has left, or of a closed chain ten cycles."""
    network = chain.network
    if not network.is_open:
        return 10 * len(network.cycle)
    mean, variance = network.open_chain.residence()
    tail = mean + np.log(1 / (1 - MOST_LEFT)) * np.sqrt(max(variance, 0.0))
    return int(np.clip(np.ceil(tail / network.step_s), 2, MOST_STEPS))


def residence_table(chain: PageChain) -> pd.DataFrame:
    """F and E by exit: chain, exit, time_s, left_share_1, leaving_rate_1_s."""
    network, steps = chain.network, horizon(chain)
    every = max(1, -(-steps // ROWS))
    # exits of the matrix to this power hold what has left after so many steps
    stride = np.linalg.matrix_power(network.product.toarray(), every)
    n, now = len(network.states), np.zeros(len(stride))
    now[:n] = network.feed / network.feed.sum()
    left = np.zeros((-(-steps // every) + 1, len(network.exits)))
    for row in range(1, len(left)):
        now = now @ stride
        left[row] = now[n:]
    times, rate = every * network.step_s, np.diff(left, axis=0, prepend=0)
    parts = [
        pd.DataFrame(
            {
                "exit": name,
                "time_s": times * np.arange(len(left)),
                "left_share_1": left[:, place],
                "leaving_rate_1_s": rate[:, place] / times,
            }
        )
        for place, name in enumerate(network.exits)
    ]
    return _named(chain, pd.concat(parts, ignore_index=True))


def pulses_table(chain: PageChain) -> pd.DataFrame:
    """Contents at the steps next to moments after the start, with the columns of `states_table` and times."""
    network, parts = chain.network, []
    steps = [round(moment / network.step_s) for moment in chain.moments_s]
    contents = network.expected(checks.start_of(chain), max(steps))
    for moment, step in zip(chain.moments_s, steps, strict=True):
        columns = _state_columns(chain)
        columns.insert(1, "moment_s", moment)
        columns.insert(2, "time_s", step * network.step_s)
        parts.append(columns.assign(declared=network.contents, content=contents[step, : len(network.states)]))
    return pd.concat(parts, ignore_index=True)


def pulse_metrics(chain: PageChain, table: pd.DataFrame) -> pd.DataFrame:
    """Numbers of the pulses of small chains with a start: content by moment and state."""
    if chain.start is None or len(chain.network.states) > SMALL:
        return pd.DataFrame(columns=["quantity", "source", "value", "unit", "ci_low", "ci_high"])
    names = [f"content_{row.time_s:g}_{row.state}" for row in table.itertuples()]
    numbers = pd.DataFrame({"quantity": names, "source": chain.name, "value": table["content"], "unit": "1"})
    return numbers.assign(ci_low=np.nan, ci_high=np.nan)


def path_table(chain: PageChain, steps: int, seed: int) -> pd.DataFrame:
    """Path of one particle: chain, time_s, state, zone, height_m; it ends where the particle leaves.

    Of several particles the one whose stay is nearest to the mean is shown, so that the path is a usual one.
    """
    network, rng, steps = chain.network, np.random.default_rng(seed), min(steps, MOST_PATH_STEPS)
    amount = network.feed if network.is_open else checks.start_of(chain)
    begin = rng.choice(len(amount), PATHS, p=amount / amount.sum())
    walked = np.array([states.copy() for states in network.walk(begin, steps, rng)])
    stays = (walked < len(network.states)).sum(axis=0)
    usual = network.open_chain.residence()[0] / network.step_s if network.is_open else steps
    path = walked[: int(stays.max()), int(np.argmin(np.abs(stays - usual)))]
    path = path[path < len(network.states)]
    columns = _state_columns(chain).iloc[path].reset_index(drop=True)
    columns.insert(1, "time_s", network.step_s * np.arange(len(path)))
    return columns


def _state_columns(chain: PageChain) -> pd.DataFrame:
    states = chain.network.states
    return _named(
        chain,
        pd.DataFrame(
            {
                "state": [state.name for state in states],
                "zone": [state.zone for state in states],
                "height_m": [state.height_m for state in states],
            }
        ),
    )


def _named(chain: PageChain, table: pd.DataFrame) -> pd.DataFrame:
    table.insert(0, "chain", chain.name)
    return table


def conversion_table(chain: PageChain) -> pd.DataFrame:
    """Share of the feed that has reacted below a height: chain, height_m, conversion_1.

    What reacts in a zone of one state is spread evenly over the height.
    """
    network = chain.network
    sums, columns = network.open_chain, _state_columns(chain)
    reacts = sums.hold_up() * sums.exits[:, network.exits.index(REACTED)] / sums.throughput
    heights = np.sort(columns["height_m"].unique())
    alone = columns.groupby("zone")["zone"].transform("size").to_numpy() == 1
    places = columns["height_m"].to_numpy()
    by_height = np.array([reacts[(places == height) & ~alone].sum() for height in heights])
    size = 2 * heights[0]
    tops, whole = heights + size / 2, heights[-1] + size / 2
    below = by_height.cumsum() + reacts[alone].sum() * tops / whole
    table = pd.DataFrame({"height_m": [0, *tops], "conversion_1": [0, *below]})
    return _named(chain, table)


def axial_table(chain: PageChain, line_m: float, times_s: Array) -> pd.DataFrame:
    """Share of low and up that is on its side: source, group, time_s, fraction_remaining_1."""
    curves = remaining(chain.network, line_m, times_s)
    parts = [
        pd.DataFrame({"source": chain.name, "group": group, "time_s": times_s, "fraction_remaining_1": curve})
        for group, curve in zip(AXIAL, curves.T, strict=True)
    ]
    return pd.concat(parts, ignore_index=True)


def axial_metrics(curves: pd.DataFrame, beside: pd.DataFrame) -> pd.DataFrame:
    """Root mean square differences of curves from the mean of the DEM runs, by source and group."""
    dem = beside[beside["source"].str.fullmatch(r"dem(_\d+)?")]
    mean = dem.groupby(["group", "time_s"])["fraction_remaining_1"].mean()
    rows = []
    for (source, group), part in pd.concat([curves, beside]).groupby(["source", "group"], sort=False):
        off = part["fraction_remaining_1"].to_numpy() - mean.loc[group].to_numpy()
        rows.append((f"error_rms_{group}", source, float(np.sqrt(np.mean(off**2))), "1", np.nan, np.nan))
    return pd.DataFrame(rows, columns=["quantity", "source", "value", "unit", "ci_low", "ci_high"])
