# SPDX-License-Identifier: GPL-3.0-or-later
"""Axial chain of a bubbling bed whose bubbles carry particles up in their wakes.

Dehling, Hoffmann, Stuut, SIAM J. Appl. Math. 60 (1999) 337-358: cells from the top (1, feed) to the bottom
(N, product); a particle sinks with the bulk, is dispersed to its neighbours, or is caught by a wake and is
at the top at once. With wakes as states of their own the bubbles have a finite speed (the multi-phase chain
of Gottschalk, Dehling and Hoffmann).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.networks.builders import Move, from_edges
from bedchain.chains.networks.network import Network, State
from bedchain.errors import DataError

Array = NDArray[np.float64]
PRODUCT = "product"
# probability to stay below 0 that is round-off [1]
ROUND_OFF = 1e-12


def axial_wakes(
    caught_1: Sequence[float],
    up_1: float,
    feed_1: float = 0.0,
    wake_1: float | None = None,
    step_s: float = 1.0,
) -> Network:
    """Chain of equal cells, each with the content 1.

    The probability to sink follows from the content staying uniform: ``d_i = u_(i+1) + sum_(j>i) l_j + f``.

    Parameters
    ----------
    caught_1 : sequence of float
        Probability in a step to be caught by a wake, of the cells from the top [1].
    up_1 : float
        Probability to be dispersed up, of all cells but the first [1].
    feed_1 : float
        What enters the first cell in a step, of the content of a cell; 0 for a closed bed [1].
    wake_1 : float, optional
        Probability of what is in a wake to pass to the next higher cell [1]; without it wakes are at the
        top at once.
    step_s : float
        Time of a step [s].

    Returns
    -------
    Network

    Raises
    ------
    DataError
        The moves out of a cell sum to more than 1.
    """
    caught, n = np.asarray(caught_1, float), len(caught_1)
    up = np.where(np.arange(n) > 0, up_1, 0.0)
    above = caught[::-1].cumsum()[::-1]  # caught in a cell and below it
    down = np.append(up[1:] + above[1:], 0.0) + feed_1
    stays = 1 - caught - up - down
    if stays[least := int(np.argmin(stays))] < -ROUND_OFF:
        raise DataError(
            f"the moves out of cell {least + 1} sum to {1 - stays[least]:g}, more than 1: take "
            "a smaller up_1, caught_1 or feed_1, which is a shorter step"
        )
    states = [State(f"bulk {i + 1}", 1.0, n - 0.5 - i, "bulk") for i in range(n)]
    moves: list[Move] = []
    for i in range(n):
        moves += [(f"bulk {i + 1}", f"bulk {i + 1}", max(stays[i], 0.0))]
        moves += [(f"bulk {i + 1}", f"bulk {i}", up[i])] if i else []
        moves += [(f"bulk {i + 1}", f"bulk {i + 2}" if i < n - 1 else PRODUCT, down[i])] if down[i] else []
        moves += (
            [(f"bulk {i + 1}", "bulk 1" if wake_1 is None else f"wake {i + 1}", caught[i])]
            if caught[i]
            else []
        )
    if wake_1 is not None:
        held = [i for i in range(n) if above[i] > 0]
        states += [State(f"wake {i + 1}", above[i] / wake_1, n - 0.5 - i, "wake") for i in held]
        for i in held:
            moves += [
                (f"wake {i + 1}", f"wake {i}" if i else "bulk 1", wake_1),
                (f"wake {i + 1}",) * 2 + (1 - wake_1,),
            ]
    feed = {"bulk 1": feed_1} if feed_1 else {}
    return from_edges(states, [PRODUCT] if feed_1 else [], moves, feed, step_s)
