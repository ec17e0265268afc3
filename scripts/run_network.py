# SPDX-License-Identifier: GPL-3.0-or-later
"""The chains of a network page: their numbers, contents, residence times, pulses, paths and mixtures."""

from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from bedchain.chains.networks import mixture as mixture_tables
from bedchain.chains.networks import outputs
from bedchain.chains.networks.mixer import loading_variances
from bedchain.chains.networks.network import REACTED
from bedchain.chains.networks.page import PageChain, chains_of
from bedchain.errors import UserError
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage


class Tables(NamedTuple):
    """Files of the tables to make, by their names in `COLUMNS`."""

    states: Path
    residence: Path
    pulses: Path
    path: Path
    mixtures: Path
    moves: Path
    axial: Path
    conversion: Path


COLUMNS = {
    "states": ["chain", "state", "zone", "height_m", "declared", "content"],
    "residence": ["chain", "exit", "time_s", "left_share_1", "leaving_rate_1_s"],
    "pulses": ["chain", "moment_s", "time_s", "state", "zone", "height_m", "declared", "content"],
    "path": ["chain", "time_s", "state", "zone", "height_m"],
    "mixtures": ["mixture", "quantity", "revolution", "time_s", "value"],
    "moves": ["chain", "from", "to", "probability_1"],
    "axial": ["source", "group", "time_s", "fraction_remaining_1"],
    "conversion": ["chain", "height_m", "conversion_1"],
}


def run_network(network: dict[str, Any], place: str, metrics: Path, tables: Tables) -> None:
    """Make all tables of a network page.

    Parameters
    ----------
    network : dict
        Section ``network`` of a checked case.
    place : str
        The case's file, for messages.
    metrics : Path
        Table to make: quantity, source, value, unit, ci_low, ci_high.
    tables : Tables
        Of the chains and mixtures that figures show, and the moves of all; without rows where there are none.
    """
    chains = chains_of(network, place)
    by_name = {chain.name: chain for chain in chains}
    seed, particles = network["seed"], network["particles"]
    rows = [outputs.metrics_table(chain, particles, seed) for chain in chains]
    made: dict[str, list[pd.DataFrame]] = {name: [] for name in COLUMNS}
    made["moves"] = [outputs.moves_table(chain) for chain in chains]
    for chain in chains:
        if chain.start is not None and chain.moments_s:
            rows.append(outputs.pulse_metrics(chain, outputs.pulses_table(chain)))
    for chain in filter(attrgetter("shown"), chains):
        made["states"].append(outputs.states_table(chain))
        made["path"].append(outputs.path_table(chain, outputs.horizon(chain), seed))
        if chain.network.is_open:
            made["residence"].append(outputs.residence_table(chain))
        if chain.moments_s:
            made["pulses"].append(outputs.pulses_table(chain))
    for mixture in network["mixtures"]:
        table = mixture_tables.mixtures_table(mixture, by_name, place)
        made["mixtures"] += [table] if mixture["show"] else []
        rows.append(mixture_tables.mixture_metrics(table, mixture_tables.limit_of(by_name[mixture["key"]])))
    made["conversion"] = [
        outputs.conversion_table(chain)
        for chain in chains
        if chain.shown and chain.network.placed and REACTED in chain.network.exits
    ]
    if "axial" in network:
        axial = axial_curves(network["axial"], [chain for chain in chains if chain.shown], Path(place).parent)
        made["axial"].append(axial[0])
        rows.append(axial[1])
    rows += [loading_metrics(loading) for loading in network["loadings"]]
    for name, parts in made.items():
        table = pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=COLUMNS[name])
        write_csv(table[COLUMNS[name]], getattr(tables, name))
    write_csv(numbers := pd.concat([part for part in rows if len(part)], ignore_index=True), metrics)
    for row in numbers[~numbers["quantity"].str.contains(r"_\d+(?:_.*)?$")].itertuples():
        LOG.info("%s, %s: %.6g %s", row.source, row.quantity, row.value, row.unit)


def axial_curves(
    axial: dict[str, Any], chains: list[PageChain], folder: Path
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Curves of low and up of the closed chains with heights beside those of a file, and their errors.

    Raises
    ------
    UserError
        The file cannot be read, or has other columns or times.
    """
    file = folder / axial["beside"]
    try:
        beside = pd.read_csv(file, comment="#")[COLUMNS["axial"]]
    except (OSError, ValueError, KeyError) as error:
        needed = ", ".join(COLUMNS["axial"])
        raise UserError(f"{file} cannot be read ({error}): give a table of {needed}") from None
    times = np.sort(beside["time_s"].unique())
    if (beside.groupby(["source", "group"])["time_s"].count() != len(times)).any():
        raise UserError(f"{file}: its curves have different times; give all of them the same")
    closed = [chain for chain in chains if not chain.network.is_open and chain.network.placed]
    curves = pd.concat([outputs.axial_table(chain, axial["line_m"], times) for chain in closed])
    return pd.concat([curves, beside]), outputs.axial_metrics(curves, beside)


def loading_metrics(loading: dict[str, Any]) -> pd.DataFrame:
    """Variance of 0110 repeated over the smallest of all loadings, and of top against bottom over it."""
    rows, steps = loading["rows"], loading["steps"]
    variances = loading_variances(rows, steps, loading["move_1"])
    smallest = next(iter(variances.values()))
    named = {"bands": "0110" * (rows // 4), "top": "1" * (rows // 2) + "0" * (rows // 2)}
    values = {f"variance_{name}_over_smallest": variances[word] / smallest for name, word in named.items()}
    table = pd.DataFrame({"quantity": values.keys(), "value": values.values(), "unit": "1"})
    table.insert(1, "source", f"{len(variances)} loadings of {rows} rows")
    return table.assign(ci_low=float("nan"), ci_high=float("nan"))


if rule := globals().get("snakemake"):
    run_stage(run_network, rule)
