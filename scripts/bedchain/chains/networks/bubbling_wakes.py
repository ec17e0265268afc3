# SPDX-License-Identifier: GPL-3.0-or-later
"""Axial chain of a real bed: wakes, sinking bulk and dispersion by the two-phase model."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from bedchain.chains.networks.builders import Move, from_fluxes
from bedchain.chains.networks.network import Network, State
from bedchain.errors import UserError
from bedchain.physics.bubbling_bed import MINIMUM_VOIDAGE, WAKE_SHARE, BubblingBed, bubbling_bed

Array = NDArray[np.float64]


class Mechanisms(NamedTuple):
    """What moves particles up and down.

    Attributes
    ----------
    wakes : bool
        Wakes carry particles to the surface at the bubbles' velocity, and the bulk sinks.
    dispersed : bool
        Neighbours exchange particles by `dispersion`.
    """

    wakes: bool
    dispersed: bool


def bed_of_case(file: Path) -> BubblingBed:
    """Bubbling bed of a case of particles.

    Raises
    ------
    UserError
        There is no such case, it is no simulated bed, or the two-phase model does not hold for it.
    """
    case = load_case(file)
    if "gas" not in case:
        raise UserError(f"{file} is a network: take a case of particles and gas")
    return bubbling_bed(scene_of(case))


def dispersion(bed: BubblingBed) -> Array:
    """Vertical dispersion of solids [m2/s], ``f_w^2 eps_mf delta d_b u_b^2 / (3 u_mf)``, (n_heights,) array.

    Kunii, Levenspiel 1991, Fluidization Engineering, Eq. 9.12, not verified.
    """
    carried = (
        WAKE_SHARE**2 * MINIMUM_VOIDAGE * bed.bubble_share * bed.bubble_diameter * bed.bubble_velocity**2
    )
    return carried / (3 * bed.minimum_velocity)


def bubbling_wakes(bed: BubblingBed, cells: int, mechanisms: Mechanisms) -> Network:
    """Closed chain of a bed, from its contents and flows; contents are heights of emulsion [m].

    What wakes carry through a height, ``f_w delta u_b``, is caught in the cell where it grows, given back
    where it shrinks, and left at the surface; through each section as much bulk sinks as wakes rise.

    Parameters
    ----------
    bed : BubblingBed
    cells : int
        Of equal height, from the bottom.
    mechanisms : Mechanisms

    Returns
    -------
    Network
        States bulk 1 to N, then wake 1 to N where there are wakes.

    Raises
    ------
    UserError
        Bubbles and their wakes fill the bed, or nothing moves.
    """
    if not any(mechanisms):
        raise UserError("neither wakes nor dispersion: nothing would move; take one of them")
    edges = np.linspace(0, bed.bed_height, cells + 1)
    middle, size = (edges[1:] + edges[:-1]) / 2, edges[1]
    share = WAKE_SHARE if mechanisms.wakes else 0.0
    held = share * bed.bubble_share
    if (fullest := float((bed.bubble_share + held).max())) >= 1:
        raise UserError(f"bubbles and their wakes take {fullest:.2f} of the bed: no bulk is left to sink")
    bulk = in_cells(bed, 1 - bed.bubble_share - held, edges)
    states = [State(f"bulk {i + 1}", bulk[i], middle[i], "bulk") for i in range(cells)]
    moves: list[Move] = []
    if mechanisms.wakes:
        wake = in_cells(bed, held, edges)
        states += [State(f"wake {i + 1}", wake[i], middle[i], "wake") for i in range(cells)]
        moves += _carried(np.interp(edges, bed.height, held * bed.bubble_velocity))
    if mechanisms.dispersed:
        exchange = np.interp(edges[1:-1], bed.height, dispersion(bed) * (1 - bed.bubble_share - held)) / size
        for i, flow in enumerate(exchange, 1):
            moves += [(f"bulk {i}", f"bulk {i + 1}", flow), (f"bulk {i + 1}", f"bulk {i}", flow)]
    return from_fluxes(states, [], moves)


def _carried(rising: Array) -> list[Move]:
    """Flows of wakes and of the bulk that sinks, from what rises through each edge but the bottom."""
    rising = np.concatenate(([0.0], rising[1:]))
    moves: list[Move] = []
    for i in range(1, len(rising)):
        here, wake = f"bulk {i}", f"wake {i}"
        last = i == len(rising) - 1
        grown = rising[i] - rising[i - 1]
        moves.append((here, wake, max(grown, 0.0)))
        moves.append((wake, here, max(-grown, 0.0) + (rising[i] if last else 0.0)))
        if not last:
            moves += [(wake, f"wake {i + 1}", rising[i]), (f"bulk {i + 1}", here, rising[i])]
    return moves


def in_cells(bed: BubblingBed, share: Array, edges: Array) -> Array:
    """Integral of a share of the bed over each cell [m], (n_cells,) array."""
    steps = np.diff(bed.height) * (share[1:] + share[:-1]) / 2
    below = np.concatenate(([0.0], np.cumsum(steps)))
    return np.diff(np.interp(edges, bed.height, below))


def remaining(network: Network, line_m: float, times_s: Array) -> Array:
    """Share of what starts below a line, and above it, that is on its side at some times.

    Parameters
    ----------
    network : Network
        Closed, of equal cells from the bottom.
    line_m : float
        [m]; a cell that it cuts counts to both sides by its parts.
    times_s : (n_times,) array
        [s], taken at the next step.

    Returns
    -------
    (n_times, 2) array
        Of low and up [1], as groups of Fig. 5.
    """
    heights = np.array([state.height_m for state in network.states])
    size = 2 * heights.min()
    low = np.clip((line_m - heights) / size + 0.5, 0, 1)
    steps = np.rint(times_s / network.step_s).astype(int)
    curves = []
    for side in (low, 1 - low):
        start = side * network.contents
        later = network.expected(start, int(steps.max()))[steps]
        curves.append(later @ side / start.sum())
        curves[-1][steps == 0] = 1.0  # of what starts in the cut cell too, as in the groups of particles
    return np.array(curves).T
