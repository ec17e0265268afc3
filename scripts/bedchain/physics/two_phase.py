# SPDX-License-Identifier: GPL-3.0-or-later
"""The bubbling two-phase model: size, rise and share of bubbles, exchange of gas, bed height.

Lengths, velocities and times in SI units. The relations are those of Kunii, Levenspiel 1991, Fluidization
Engineering, ch. 5, 6, 10 and 12 (KL), where nothing else is said. Outside its range it raises `RegimeError`.
"""

import math
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bedchain.errors import UserError
from bedchain.physics.constants import GRAVITY_M_S2

Regime = Literal["slow", "intermediate", "fast", "vigorous"]
Array = NDArray[np.float64]
REGIMES: tuple[Regime, ...] = get_args(Regime)
RISE_FACTOR = 0.711  # of a single bubble: Davies, Taylor 1950
WALL_RANGE = (0.125, 0.6)  # bubble over bed diameter: walls slow the bubble between, slugs beyond (KL 6.8)
FAST_RATIO = 5.0  # of u_b to the gas velocity of the emulsion: from here on bubbles have thin clouds (KL 6.4)
VIGOROUS_RATIO = 10.0  # of u to u_mf: u >> u_mf, our choice; u / u_b differs by a tenth at most


class RegimeError(UserError):
    """The two-phase model does not hold; `regime` names what stands in its place."""

    def __init__(self, regime: str, reason: str) -> None:
        self.regime = regime
        super().__init__(f"the two-phase model does not hold in this regime, {regime}: {reason}")


def darton_diameter(height: ArrayLike, excess: float, area: float = 0.0) -> Array:
    """Diameter of bubbles by Darton et al. 1977, Trans. IChemE 55, 274, not verified [m].

    Parameters
    ----------
    height : (...) array or float
        Above the distributor [m].
    excess : float
        Superficial velocity less that of minimum fluidization [m/s].
    area : float
        Of the distributor for each orifice [m2]; 0 for a porous plate that bubbles grow on from nothing.
    """
    return 0.54 * excess**0.4 * (np.asarray(height) + 4 * math.sqrt(area)) ** 0.8 * GRAVITY_M_S2**-0.2


def werther_diameter(height: ArrayLike, excess: float) -> Array:
    """Diameter of bubbles by Werther 1978 for fine particles on a porous plate (KL 6.6) [m].

    Parameters
    ----------
    height, excess
        As of `darton_diameter`.
    """
    return 0.01 * 0.853 * (1 + 0.272 * excess * 100) ** (1 / 3) * (1 + 6.84 * np.asarray(height)) ** 1.21


def largest_diameter(excess: float, width: float) -> float:
    """Diameter that bubbles grow towards in a round bed by Mori, Wen 1975 (KL 6.5) [m].

    Parameters
    ----------
    excess : float
        As of `darton_diameter`.
    width : float
        Diameter of the bed [m].
    """
    return 0.01 * 0.65 * (math.pi / 4 * (100 * width) ** 2 * 100 * excess) ** 0.4


def mori_wen_diameter(height: ArrayLike, excess: float, width: float, start: float) -> Array:
    """Diameter of bubbles by Mori, Wen 1975, AIChE J. 21, 109 (KL 6.4) [m].

    Parameters
    ----------
    height, excess
        As of `darton_diameter`.
    width : float
        Diameter of the bed [m].
    start : float
        Diameter at the distributor [m].
    """
    largest = largest_diameter(excess, width)
    return largest - (largest - start) * np.exp(-0.3 * np.asarray(height) / width)


def single_rise_velocity(diameter: ArrayLike, width: float | None = None) -> Array:
    """Rise velocity of a single bubble [m/s], ``0.711 sqrt(g d_b)`` (KL 6.7, 6.8).

    Parameters
    ----------
    diameter : (...) array or float
        Of the bubble [m].
    width : float, optional
        Of the bed [m]: between 0.125 and 0.6 widths ``1.2 exp(-1.49 d_b / d_t)`` times as fast. Without it
        walls are far.

    Raises
    ------
    RegimeError
        Slugging: a bubble of 0.6 widths or more.
    """
    free = RISE_FACTOR * np.sqrt(GRAVITY_M_S2 * np.asarray(diameter))
    if width is None:
        return free
    refuse_slugs(diameter, width)
    share = np.asarray(diameter) / width
    return np.where(share > WALL_RANGE[0], 1.2 * np.exp(-1.49 * share), 1.0) * free


def refuse_slugs(diameter: ArrayLike, width: float) -> None:
    """Raise `RegimeError` where a bubble is of 0.6 widths [m] or more (KL 6.1)."""
    if (largest := float(np.max(diameter))) >= WALL_RANGE[1] * width:
        raise RegimeError(
            "slugging",
            f"bubbles grow to {largest:.3g} m, {largest / width:.2f} of the width",
        )


def bubble_velocity(diameter: ArrayLike, excess: float, width: float | None = None) -> Array:
    """Rise velocity of bubbles in a bubbling bed [m/s], ``u - u_mf + u_br`` (KL 6.9).

    Parameters
    ----------
    diameter, width
        As of `single_rise_velocity`.
    excess : float
        As of `darton_diameter`.
    """
    return excess + single_rise_velocity(diameter, width)


def regime_of(velocity: float, minimum: float, voidage: float, bubble: float) -> Regime:
    """Regime of bubbles of one velocity (KL 6.4).

    Parameters
    ----------
    velocity, minimum : float
        Superficial, and that of minimum fluidization [m/s].
    voidage : float
        At minimum fluidization [1].
    bubble : float
        `bubble_velocity` [m/s].

    Raises
    ------
    RegimeError
        Fixed bed: the gas carries no bed.
    """
    if velocity <= minimum:
        raise RegimeError("fixed bed", f"the gas has {velocity:.3g} m/s, u_mf is {minimum:.3g} m/s")
    emulsion = minimum / voidage
    if bubble < emulsion:
        return "slow"
    if bubble < FAST_RATIO * emulsion:
        return "intermediate"
    return "vigorous" if velocity >= VIGOROUS_RATIO * minimum else "fast"


def bubble_share(velocity: float, minimum: float, voidage: float, bubble: ArrayLike, regime: Regime) -> Array:
    """Share of the bed that bubbles take [1] (KL 6.20, 6.26 to 6.29).

    Slow bubbles let gas through, ``(u - u_mf) / (u_b + 2 u_mf)``; intermediate ones go over from
    ``(u - u_mf) / (u_b + u_mf)`` to ``(u - u_mf) / u_b``; fast ones take it along,
    ``(u - u_mf) / (u_b - u_mf)``; vigorous ``u / u_b``.

    Parameters
    ----------
    velocity, minimum, voidage
        As of `regime_of`.
    bubble : (...) array or float
        `bubble_velocity` [m/s].
    regime : {"slow", "intermediate", "fast", "vigorous"}
        Of `regime_of`.

    Raises
    ------
    RegimeError
        Bubbles of the regime would fill the bed.
    """
    excess, bubble = velocity - minimum, np.asarray(bubble, dtype=float)
    if regime == "slow":
        share = excess / (bubble + 2 * minimum)
    elif regime == "intermediate":
        past = np.clip((bubble * voidage / minimum - 1) / (FAST_RATIO - 1), 0, 1)
        share = excess / (bubble + (1 - past) * minimum)
    elif regime == "fast":
        share = excess / (bubble - minimum)
    else:
        share = velocity / bubble
    if not np.all((share >= 0) & (share < 1)):
        raise RegimeError("turbulent", f"{regime} bubbles would take {float(np.max(share)):.2f} of the bed")
    return share


def bubble_cloud_exchange(minimum: float, diameter: ArrayLike, diffusivity: float) -> Array:
    """Gas exchanged between bubble and cloud, over the bubble's volume [1/s] (KL 10.27).

    ``4.5 u_mf / d_b + 5.85 D^0.5 g^0.25 / d_b^1.25``.

    Parameters
    ----------
    minimum : float
        Velocity of minimum fluidization [m/s].
    diameter : (...) array or float
        Of the bubble [m].
    diffusivity : float
        Of the gas [m2/s].
    """
    diameter = np.asarray(diameter, dtype=float)
    diffusion = 5.85 * math.sqrt(diffusivity) * GRAVITY_M_S2**0.25
    return 4.5 * minimum / diameter + diffusion / diameter**1.25


def cloud_emulsion_exchange(voidage: float, diameter: ArrayLike, diffusivity: float) -> Array:
    """Gas exchanged between cloud and emulsion, over the bubble's volume [1/s] (KL 10.34).

    ``6.77 (D eps_mf 0.711 (g d_b)^0.5 / d_b^3)^0.5``.

    Parameters
    ----------
    voidage : float
        At minimum fluidization [1].
    diameter, diffusivity
        As of `bubble_cloud_exchange`.
    """
    return 6.77 * np.sqrt(diffusivity * voidage * single_rise_velocity(diameter) / np.asarray(diameter) ** 3)


def bubble_emulsion_exchange(
    minimum: float, voidage: float, diameter: ArrayLike, diffusivity: float
) -> Array:
    """Gas exchanged by bubble and emulsion through the cloud, over the bubble's volume [1/s] (KL 10.14).

    Parameters
    ----------
    minimum, voidage, diameter, diffusivity
        As of `bubble_cloud_exchange` and `cloud_emulsion_exchange`.
    """
    inner = bubble_cloud_exchange(minimum, diameter, diffusivity)
    outer = cloud_emulsion_exchange(voidage, diameter, diffusivity)
    return inner * outer / (inner + outer)


def cloud_solids(minimum: float, voidage: float, diameter: float, wake_share: float) -> float:
    """Solids in cloud and wake over the bubble's volume [1] (KL 6.36).

    ``(1 - eps_mf) (3 / (u_br eps_mf / u_mf - 1) + f_w)``.

    Parameters
    ----------
    minimum, voidage
        As of `regime_of`.
    diameter : float
        Of the bubble [m].
    wake_share : float
        Volume of the wake over that of the bubble [1].

    Raises
    ------
    RegimeError
        Slow bubbles: gas flows through them, and they have no cloud.
    """
    ratio = float(single_rise_velocity(diameter)) * voidage / minimum
    if ratio <= 1:
        raise RegimeError(
            "slow bubbles",
            f"a single bubble rises at {ratio:.2f} of the gas velocity in the emulsion: no cloud",
        )
    return (1 - voidage) * (3 / (ratio - 1) + wake_share)
