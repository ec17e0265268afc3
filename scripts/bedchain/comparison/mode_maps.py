# SPDX-License-Identifier: GPL-3.0-or-later
"""Modes and circulation of a chain: rows of diagnostics.csv, and maps over the bed for modes.csv."""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains.circulation import Circulation
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.modes import Modes
from bedchain.comparison.metrics import Metric, metric
from bedchain.trajectory.grid import Grid

COLUMNS = ("source", "quantity", "part", "cell", "x_m", "z_m", "value", "unit")
# slowest processes of the maps; a pair that goes round is one
SHOWN = 2


def mode_rows(chain: MarkovChain, modes: Modes, flow: Circulation) -> list[Metric]:
    """What modes and circulation say in a few numbers.

    Parameters
    ----------
    chain : MarkovChain
    modes : Modes
    flow : Circulation

    Returns
    -------
    list of dict
        mode_held_share and, where a process goes round, mode_period, by part as implied_timescale;
        net_flux_share, one_way_flux_share, entropy_production.
    """
    where: dict[str, Any] = {"lag_s": chain.lag_s}
    periods = zip(modes.held, modes.periods_s(chain.lag_s), strict=True)
    rows = []
    for number, (held, period) in enumerate(periods, 1):
        rows.append(metric("mode_held_share", chain.name, held, part=str(number), **where))
        if np.isfinite(period):
            rows.append(metric("mode_period", chain.name, period, "s", part=str(number), **where))
    return [
        *rows,
        metric("net_flux_share", chain.name, flow.net_share, **where),
        metric("one_way_flux_share", chain.name, flow.one_way_share, **where),
        metric("entropy_production", chain.name, flow.entropy_1_s.sum(), "1/s", **where),
    ]


def mode_maps(chain: MarkovChain, modes: Modes, flow: Circulation) -> pd.DataFrame:
    """Maps of the slowest processes and of the circulation.

    Parameters
    ----------
    chain : MarkovChain
    modes : Modes
    flow : Circulation

    Returns
    -------
    DataFrame
        `COLUMNS`, a row for each cell and quantity: timescale [s] and excess [1] of each of the slowest
        processes (part: 1 the slowest), scaled to the largest size 1; flow_x and flow_z, times the share of
        the particles [m/s]; density [1]; entropy_production [1/s].
    """
    once = np.flatnonzero(modes.eigenvalues.imag >= 0)[:SHOWN]
    scales = modes.timescales_s(chain.lag_s)
    maps = [("excess", str(at + 1), "1", excess(chain, modes, mode)) for at, mode in enumerate(once)]
    maps += [
        ("timescale", str(at + 1), "s", np.full(chain.grid.n_cells, scales[mode]))
        for at, mode in enumerate(once)
    ]
    maps += [
        ("flow_x", "", "m/s", flow.flow_m_s[:, 0]),
        ("flow_z", "", "m/s", flow.flow_m_s[:, 1]),
        ("density", "", "1", flow.density),
        ("entropy_production", "", "1/s", flow.entropy_1_s),
    ]
    return pd.concat([_table(chain.name, chain.grid, *values) for values in maps], ignore_index=True)


def excess(chain: MarkovChain, modes: Modes, mode: int) -> NDArray[np.float64]:
    """Excess of particles by cell while a process decays, largest size 1, (n_cells,) [1].

    Of a pair that goes round, at the moment when the excess is largest.
    """
    left = modes.left[:, mode]
    cells = [np.bincount(chain.cell_of_state, part, chain.grid.n_cells) for part in (left.real, left.imag)]
    whole = cells[0] + 1j * cells[1]
    turned = (whole * np.exp(-0.5j * np.angle((whole**2).sum()))).real
    largest = turned[np.argmax(np.abs(turned))]
    return np.asarray(turned / largest if largest else turned)


def _table(source: str, grid: Grid, quantity: str, part: str, unit: str, values: np.ndarray) -> pd.DataFrame:
    x, z = grid.centres_m.T
    cell = np.arange(grid.n_cells)
    columns = (source, quantity, part, cell, x, z, values, unit)
    return pd.DataFrame(dict(zip(COLUMNS, columns, strict=True)))
