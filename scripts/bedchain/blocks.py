# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the blocks of time are that error bars are drawn from."""

import numpy as np

from bedchain.bootstrap import correlation_steps
from bedchain.comparison import BLOCK_CORRELATIONS, FEWEST_BLOCKS
from bedchain.frames import Frames


def block_length(frames: Frames, split_x_m: float, lag: int) -> int:
    """Length of the blocks that are drawn again: longer than the bed remembers, short against the window.

    Parameters
    ----------
    frames : Frames
        The learning window.
    split_x_m : float
        The line between left and right [m].
    lag : int
        Frames in a step of the chain.

    Returns
    -------
    int
        Steps.
    """
    left = np.array([(x < split_x_m).mean() for x in frames.x_m])
    height = np.array([z.mean() for z in frames.z_m])
    remembered = max(correlation_steps(left), correlation_steps(height), lag)
    return int(np.clip(BLOCK_CORRELATIONS * remembered, 1, max(1, (len(left) - lag) // FEWEST_BLOCKS)))
