# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of a first-order reaction in closed form: plug flow, tanks, dispersion, two and three phases.

Rates are first order; K t is a rate times the residence time [1].
"""

import math

import numpy as np
from scipy.linalg import expm


def plug_flow(number: float) -> float:
    """Conversion in plug flow [1], ``1 - exp(-K t)``."""
    return -math.expm1(-number)


def tanks(number: float, cells: int) -> float:
    """Conversion in mixed tanks in series [1], ``1 - (1 + K t / N)^-N``."""
    return 1 - (1 + number / cells) ** -cells


def dispersed(number: float, peclet: float) -> float:
    """Conversion in plug flow with dispersion, in a closed vessel [1].

    ``1 - 4 a exp(Pe/2) / ((1 + a)^2 exp(a Pe/2) - (1 - a)^2 exp(-a Pe/2))``, ``a = sqrt(1 + 4 K t / Pe)``:
    Wehner, Wilhelm 1956, Chem. Eng. Sci. 6, 89, not verified; the tests solve its equation.

    Parameters
    ----------
    number : float
        K t [1].
    peclet : float
        Pe, velocity times length over dispersion [1].
    """
    root = math.sqrt(1 + 4 * number / peclet)
    lost = (1 - root) ** 2 * math.exp(-root * peclet)
    return 1 - 4 * root * math.exp((1 - root) * peclet / 2) / ((1 + root) ** 2 - lost)


def dispersed_variance(peclet: float) -> float:
    """Variance of the residence time over its mean squared in a closed vessel [1].

    ``2 / Pe - 2 (1 - exp(-Pe)) / Pe^2`` (Levenspiel, van der Laan; the tests take it from a chain).
    """
    return 2 / peclet + 2 * math.expm1(-peclet) / peclet**2


def mixed_emulsion(bubble_share: float, crossflow: float, number: float) -> float:
    """Conversion with bubbles in plug flow and a mixed emulsion that alone reacts [1].

    ``X = 1 - b exp(-X_c) - (1 - b exp(-X_c))^2 / (k' + 1 - b exp(-X_c))``: Orcutt, Davidson,
    Pigford 1962; Davidson, Harrison 1963, Fluidised Particles; not verified, derived from two balances.

    Parameters
    ----------
    bubble_share : float
        Share b of the gas that goes as bubbles [1].
    crossflow : float
        Exchange X_c between a bubble and the emulsion while it rises, over its volume [1].
    number : float
        k' = K t of all the gas in the emulsion [1].
    """
    passed = bubble_share * math.exp(-crossflow)
    return 1 - passed - (1 - passed) ** 2 / (number + 1 - passed)


def two_phases(height: float, flows: tuple[float, float], exchange: float, reaction: float) -> float:
    """Conversion with bubbles and emulsion both in plug flow, by the matrix exponential [1].

    ``q_b dc_b/dz = -m (c_b - c_e)``, ``q_e dc_e/dz = m (c_b - c_e) - k c_e``.

    Parameters
    ----------
    height : float
        [m].
    flows : (float, float)
        Superficial velocities of the gas in bubbles and in the emulsion, q_b and q_e [m/s].
    exchange : float
        m, ``delta K_be`` [1/s].
    reaction : float
        k, over the volume of the bed, ``(1 - delta) K_r`` [1/s].
    """
    flow = np.array(flows)
    system = np.array([[-exchange, exchange], [exchange, -exchange - reaction]]) / flow[:, None]
    return float(1 - flow @ expm(height * system) @ np.ones(2) / flow.sum())


def three_phase_rate(rates: tuple[float, float, float], inner: float, outer: float) -> float:
    """Overall rate of a bubble that exchanges with its cloud and that with the emulsion [1/s].

    ``K_f = g_b K + 1 / (1/K_bc + 1 / (g_c K + 1 / (1/K_ce + 1/(g_e K))))`` (Kunii, Levenspiel 1991, 12.16).

    Parameters
    ----------
    rates : (float, float, float)
        Reaction in bubble, cloud and emulsion over the bubble's volume, ``g K`` [1/s].
    inner, outer : float
        K_bc and K_ce [1/s].
    """
    bubble, cloud, emulsion = rates
    return bubble + 1 / (1 / inner + 1 / (cloud + 1 / (1 / outer + 1 / emulsion)))
