# SPDX-License-Identifier: GPL-3.0-or-later
"""Riser: particles rise in the core and sink at the wall; with a dense bottom and an exit box, four zones.

In the manner of Harris, Thorpe, Davidson, Chem. Eng. Sci. 57 (2002) 4779.
"""

import math
from typing import NamedTuple

from bedchain.chains.networks.builders import Move, from_edges, from_rates
from bedchain.chains.networks.network import Network, State
from bedchain.errors import DataError

OUTLET = "outlet"


class Exchange(NamedTuple):
    """Moves out of the cells of core and annulus, in a step or in a second.

    Attributes
    ----------
    up, down : float
        Of the core to the cell above, of the annulus to the cell below.
    to_annulus, to_core : float
    refluxed : float
        Share of what reaches the top that returns by the annulus [1].
    dense : float, optional
        Out of a dense bottom zone, with which there is an exit box too; without it there is neither.
    box : float
        Out of the exit box.
    """

    up: float
    down: float
    to_annulus: float
    to_core: float
    refluxed: float
    dense: float | None = None
    box: float = 1.0


def riser(cells: int, height_m: float, up_m_s: float, down_m_s: float, exchange: Exchange) -> Network:
    """Riser from velocities and rates; its mean residence time tends to `mean_residence_s` with the cells.

    Parameters
    ----------
    cells : int
        Cells of the core, and of the annulus.
    height_m : float
        [m].
    up_m_s, down_m_s : float
        Velocities of the particles in the core and in the annulus [m/s].
    exchange : Exchange
        Rates to_annulus and to_core, of the dense zone and the box [1/s]; up and down follow from the
        velocities.

    Returns
    -------
    Network
        Fed with 1 a second.
    """
    rates = exchange._replace(up=up_m_s * cells / height_m, down=down_m_s * cells / height_m)
    states, moves = _parts(cells, rates, height_m / cells)
    return from_rates(states, [OUTLET], moves, {states[0].name: 1.0})


def riser_steps(cells: int, exchange: Exchange) -> Network:
    """Riser from probabilities in a step: what is not exchanged moves on by a cell; see `riser`.

    Parameters
    ----------
    cells : int
    exchange : Exchange
        Probabilities in a step; up and down are what is left of 1.

    Raises
    ------
    DataError
        A probability is above 1.
    """
    for name in ("to_annulus", "to_core", "refluxed", "dense"):
        value = getattr(exchange, name)
        if value is not None and not 0 <= value <= 1:
            raise DataError(f"{name} is {value:g}: a probability is between 0 and 1")
    steps = exchange._replace(up=1 - exchange.to_annulus, down=1 - exchange.to_core)
    states, moves = _parts(cells, steps, 1.0)
    out: dict[str, float] = {}
    for origin, _, value in moves:
        out[origin] = out.get(origin, 0.0) + value
    stays = [(name, name, 1 - total) for name, total in out.items() if total < 1]
    return from_edges(states, [OUTLET], [*moves, *stays], {states[0].name: 1.0})


def mean_residence_s(
    height_m: float,
    up_m_s: float,
    down_m_s: float,
    to_annulus_1_s: float,
    to_core_1_s: float,
    refluxed_1: float,
) -> float:
    """Mean residence time in core and annulus of a continuous riser [s].

    ``T = H/u + (1/u + 1/w) [(p/k)(H - E) + R/(1 - R) E]`` with ``p = alpha/u``, ``q = beta/w``,
    ``k = q - p`` and ``E = (1 - exp(-k H))/k``: contents of core and annulus over the net flow, which is
    the same at all heights.

    Parameters
    ----------
    height_m, up_m_s, down_m_s : float
        [m], [m/s], [m/s].
    to_annulus_1_s, to_core_1_s : float
        Rates of exchange alpha, beta [1/s].
    refluxed_1 : float
        Share R that returns from the top [1].
    """
    p, q = to_annulus_1_s / up_m_s, to_core_1_s / down_m_s
    k = q - p
    near = abs(k) * height_m < 1e-6  # differences of nearly equal numbers would lose all digits
    reach = height_m if near else -math.expm1(-k * height_m) / k
    gathered = p * height_m**2 / 2 if near else p / k * (height_m - reach)
    return height_m / up_m_s + (1 / up_m_s + 1 / down_m_s) * (
        gathered + refluxed_1 / (1 - refluxed_1) * reach
    )


def _parts(cells: int, exchange: Exchange, size_m: float) -> tuple[list[State], list[Move]]:
    """States with their contents at a feed of 1, and moves."""
    up, down, out, back, refluxed, dense, box = exchange
    core, annulus = _contents(cells, exchange)
    raised = 0.0 if dense is None else size_m
    high = [raised + (i + 0.5) * size_m for i in range(cells)]
    states = [State(f"core {i + 1}", core[i], high[i], "core") for i in range(cells)]
    states += [State(f"annulus {i + 1}", annulus[i], high[i], "annulus") for i in range(cells)]
    moves: list[Move] = []
    for i in range(cells):
        here, wall = f"core {i + 1}", f"annulus {i + 1}"
        moves += [(here, wall, out), (wall, here, back)]
        moves += [(here, f"core {i + 2}", up)] if i < cells - 1 else []
        moves += [(wall, f"annulus {i}", down)] if i else []
    last, wall, bottom = f"core {cells}", f"annulus {cells}", "annulus 1"
    if dense is None:
        moves += [(last, OUTLET, up * (1 - refluxed)), (last, wall, up * refluxed), (bottom, "core 1", down)]
        return _held(states, moves)
    states.insert(0, State("dense zone", (1 + annulus[0] * down) / dense, size_m / 2, "dense zone"))
    states.append(State("exit box", 1 / (1 - refluxed) / box, raised + (cells + 0.5) * size_m, "exit box"))
    moves += [("dense zone", "core 1", dense), (last, "exit box", up), (bottom, "dense zone", down)]
    moves += [("exit box", OUTLET, box * (1 - refluxed)), ("exit box", wall, box * refluxed)]
    return _held(states, moves)


def _held(states: list[State], moves: list[Move]) -> tuple[list[State], list[Move]]:
    """States that hold something, and moves among them: without exchange and reflux there is no annulus."""
    empty = {state.name for state in states if state.content == 0}
    return [state for state in states if state.name not in empty], [
        move for move in moves if empty.isdisjoint(move[:2])
    ]


def _contents(cells: int, exchange: Exchange) -> tuple[list[float], list[float]]:
    """Contents of core and annulus at a feed of 1, from the top down by the net flow through each section."""
    core: list[float] = []
    annulus: list[float] = []
    rising, sinking = 1 / (1 - exchange.refluxed), exchange.refluxed / (1 - exchange.refluxed)
    for _ in range(cells):  # rising leaves the cell at its top, sinking enters its annulus there
        core.insert(0, rising / exchange.up)
        annulus.insert(0, (sinking + core[0] * exchange.to_annulus) / (exchange.to_core + exchange.down))
        sinking = annulus[0] * exchange.down
        rising = 1 + sinking
    return core, annulus
