# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas through a bed with a first-order reaction, as chains whose exit ``reacted`` takes what reacts.

Each has the closed form of `physics.reactors` that it tends to with its number of cells.
"""

from typing import NamedTuple

import numpy as np

from bedchain.chains.networks.builders import Move, from_rates
from bedchain.chains.networks.network import REACTED, Network, State
from bedchain.errors import DataError
from bedchain.physics import reactors, two_phase

OUTLET = "outlet"
Closed = tuple[Network, dict[str, float]]


def tanks(
    cells: int, residence_s: float, rate_1_s: float, peclet_1: float | None, height_m: float = 1.0
) -> Closed:
    """Tanks in series, or with backflow the cells of plug flow with dispersion.

    Parameters
    ----------
    cells : int
    residence_s : float
        Mean residence time of the gas [s].
    rate_1_s : float
        Of the reaction, 0 for a tracer [1/s].
    peclet_1 : float, optional
        Velocity times length over dispersion [1]: backflow between cells of ``N / Pe - 1/2`` of the flow.
    height_m : float
        [m].

    Raises
    ------
    DataError
        There are too few cells for the Peclet number: their own dispersion is larger.
    """
    through = cells / residence_s
    back = 0.0 if peclet_1 is None else (cells / peclet_1 - 0.5) * through
    if peclet_1 is not None and back < 0:
        raise DataError(
            f"{cells} cells disperse more than Pe {peclet_1:g} asks: take at least {peclet_1 / 2:.0f}"
        )
    states = [
        State(f"gas {i + 1}", residence_s / cells, (i + 0.5) * height_m / cells, "gas") for i in range(cells)
    ]
    moves: list[Move] = [(f"gas {cells}", OUTLET, through)]
    for i in range(1, cells):
        moves += [(f"gas {i}", f"gas {i + 1}", through + back), (f"gas {i + 1}", f"gas {i}", back)]
    number = rate_1_s * residence_s
    network = _reacting(states, moves, {"gas": rate_1_s}, {"gas 1": 1.0})
    if not rate_1_s:
        variance = 1 / cells if peclet_1 is None else reactors.dispersed_variance(peclet_1)
        return network, {"relative_variance_closed_form": variance}
    closed = reactors.tanks(number, cells) if peclet_1 is None else reactors.dispersed(number, peclet_1)
    return network, {"conversion_closed_form": closed, "conversion_plug_flow": reactors.plug_flow(number)}


def mixed_emulsion(
    cells: int, bubble_share_1: float, crossflow_1: float, rate_1_s: float, height_m: float = 1.0
) -> Closed:
    """Bubbles in plug flow beside one mixed emulsion that reacts; residence time 1 s.

    Parameters
    ----------
    cells : int
        Of the bubbles.
    bubble_share_1 : float
        Share of the gas that goes as bubbles [1].
    crossflow_1 : float
        Exchange with the emulsion while a bubble rises, over its volume [1].
    rate_1_s : float
        Of the reaction in the emulsion, of all the gas [1/s].
    height_m : float
        [m].
    """
    heights = (np.arange(cells) + 0.5) * height_m / cells
    size = bubble_share_1 / cells  # volumes for a residence time of 1 s in both
    states = [State(f"bubble {i + 1}", size, heights[i], "bubble") for i in range(cells)]
    states.append(State("emulsion", 1 - bubble_share_1, height_m / 2, "emulsion"))
    given = crossflow_1 * bubble_share_1 / cells / (1 - bubble_share_1)
    moves: list[Move] = []
    for i in range(cells):
        above = f"bubble {i + 2}" if i < cells - 1 else OUTLET
        moves += [(f"bubble {i + 1}", above, float(cells)), (f"bubble {i + 1}", "emulsion", crossflow_1)]
        moves.append(("emulsion", f"bubble {i + 1}", given))
    moves.append(("emulsion", OUTLET, 1.0))
    feed = {"bubble 1": bubble_share_1, "emulsion": 1 - bubble_share_1}
    network = _reacting(states, moves, {"emulsion": rate_1_s / (1 - bubble_share_1)}, feed)
    return network, {"conversion_closed_form": reactors.mixed_emulsion(bubble_share_1, crossflow_1, rate_1_s)}


class Bubbles(NamedTuple):
    """Gas and bubbles of a bed, each of one size over its height.

    Attributes
    ----------
    cells : int
    height_m : float
        Of the bubbling bed [m].
    velocity_m_s, minimum_m_s : float
        Superficial velocity, and that of minimum fluidization [m/s].
    bubble_diameter_m : float
        [m].
    rate_1_s : float
        Of the reaction over the volume of emulsion, or of solids in three phases [1/s].
    """

    cells: int
    height_m: float
    velocity_m_s: float
    minimum_m_s: float
    bubble_diameter_m: float
    rate_1_s: float

    @property
    def rise_m_s(self) -> float:
        """Rise velocity of the bubbles [m/s]."""
        excess = self.velocity_m_s - self.minimum_m_s
        return float(two_phase.bubble_velocity(self.bubble_diameter_m, excess))

    def share(self, voidage: float, regime: two_phase.Regime) -> float:
        """Share of the bed that bubbles take [1]."""
        given = self.velocity_m_s, self.minimum_m_s, voidage, self.rise_m_s, regime
        return float(two_phase.bubble_share(*given))


def two_phases(bubbles: Bubbles, exchange_1_s: float) -> Closed:
    """Fast bubbles and emulsion, both in plug flow.

    Parameters
    ----------
    bubbles : Bubbles
    exchange_1_s : float
        K_be, over the bubbles' volume [1/s].
    """
    cells, size = bubbles.cells, bubbles.height_m / bubbles.cells
    share = bubbles.share(1.0, "fast")
    through = share * bubbles.rise_m_s, (1 - share) * bubbles.minimum_m_s
    volumes = share * size, (1 - share) * size
    states, moves = _columns(("bubble", "emulsion"), volumes, through, cells, size)
    for i in range(1, cells + 1):
        moves.append((f"bubble {i}", f"emulsion {i}", exchange_1_s))
        moves.append((f"emulsion {i}", f"bubble {i}", exchange_1_s * share / (1 - share)))
    feed = {"bubble 1": through[0], "emulsion 1": through[1]}
    network = _reacting(states, moves, {"emulsion": bubbles.rate_1_s}, feed)
    reaction = (1 - share) * bubbles.rate_1_s
    closed = reactors.two_phases(bubbles.height_m, through, share * exchange_1_s, reaction)
    return network, {"conversion_closed_form": closed}


class Grains(NamedTuple):
    """Bed of the three-phase model.

    Attributes
    ----------
    voidage_1 : float
        At minimum fluidization [1].
    wake_share_1, bubble_solids_1 : float
        Volume of the wake, and of solids in the bubble, over the bubble's volume [1].
    diffusivity_m2_s : float
        Of the gas [m2/s].
    """

    voidage_1: float
    wake_share_1: float
    bubble_solids_1: float
    diffusivity_m2_s: float


def three_phases(bubbles: Bubbles, grains: Grains) -> Closed:
    """Bubbles in plug flow that exchange gas with their clouds, and those with the emulsion.

    Contents are volumes of bubbles, for cloud and emulsion too: conversions do not depend on
    them.

    Raises
    ------
    RegimeError
        Bubbles are slow and have no clouds, or would fill the bed.
    """
    cells, size, voidage = bubbles.cells, bubbles.height_m / bubbles.cells, grains.voidage_1
    minimum, diameter = bubbles.minimum_m_s, bubbles.bubble_diameter_m
    share = bubbles.share(voidage, "vigorous")
    inner = float(two_phase.bubble_cloud_exchange(minimum, diameter, grains.diffusivity_m2_s))
    outer = float(two_phase.cloud_emulsion_exchange(voidage, diameter, grains.diffusivity_m2_s))
    cloud = two_phase.cloud_solids(minimum, voidage, diameter, grains.wake_share_1)
    emulsion = (1 - voidage) * (1 - share) / share - cloud - grains.bubble_solids_1
    zones = ("bubble", "cloud", "emulsion")
    rates = dict(
        zip(zones, bubbles.rate_1_s * np.array([grains.bubble_solids_1, cloud, emulsion]), strict=True)
    )
    flows = (share * bubbles.rise_m_s, 0.0, 0.0)
    states, moves = _columns(zones, (share * size,) * 3, flows, cells, size)
    for i in range(1, cells + 1):
        for one, other, exchange in (("bubble", "cloud", inner), ("cloud", "emulsion", outer)):
            moves += [(f"{one} {i}", f"{other} {i}", exchange), (f"{other} {i}", f"{one} {i}", exchange)]
    network = _reacting(states, moves, rates, {"bubble 1": flows[0]})
    overall = reactors.three_phase_rate((rates["bubble"], rates["cloud"], rates["emulsion"]), inner, outer)
    return network, {
        "rate_closed_form": float(overall),
        "exchange_bubble_cloud": inner,
        "exchange_cloud_emulsion": outer,
        "rise_velocity": bubbles.rise_m_s,
        "conversion_closed_form": reactors.plug_flow(overall * bubbles.height_m / bubbles.rise_m_s),
        "bubble_share": share,
        "solids_in_clouds": cloud,
        "solids_in_emulsion": emulsion,
    }


def _columns(
    zones: tuple[str, ...],
    volumes: tuple[float, ...],
    through: tuple[float, ...],
    cells: int,
    size: float,
) -> tuple[list[State], list[Move]]:
    """Cells of zones side by side, with the gas that goes up in each."""
    states = [
        State(f"{zone} {i + 1}", volume, (i + 0.5) * size, zone)
        for zone, volume in zip(zones, volumes, strict=True)
        for i in range(cells)
    ]
    moves: list[Move] = []
    for zone, volume, flow in zip(zones, volumes, through, strict=True):
        targets = [*(f"{zone} {i}" for i in range(2, cells + 1)), OUTLET] if flow else []
        moves += [(f"{zone} {i}", target, flow / volume) for i, target in enumerate(targets, 1)]
    return states, moves


def _reacting(
    states: list[State], moves: list[Move], rates: dict[str, float], feed: dict[str, float]
) -> Network:
    """Network with a rate of reaction in each zone; without any it has the outlet alone."""
    reacts = [(state.name, REACTED, rates[state.zone]) for state in states if rates.get(state.zone)]
    return from_rates(states, [OUTLET, REACTED] if reacts else [OUTLET], [*moves, *reacts], feed)
