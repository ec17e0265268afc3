# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of the chains at their extremes."""

import numpy as np

from bedchain.chains import registry
from bedchain.studies.stability.chain_settings import WalkerWindow, learn_shut
from bedchain.studies.stability.walkers import lifted_last


def test_the_guard_off_differs_in_the_trap_only():
    one = WalkerWindow(top=0.5, change=lifted_last).case()
    open_chain = registry.learn("static", one.frames, one.grid)
    shut = learn_shut("static", one.frames, one.grid)
    differing = np.flatnonzero(np.abs(open_chain.matrix - shut.matrix).sum(axis=1) > 1e-12)
    assert differing.size == 1
    assert shut.matrix[differing[0], differing[0]] == 1.0
