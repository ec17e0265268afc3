# SPDX-License-Identifier: GPL-3.0-or-later
"""The chains at their extremes: every setting of the reduced set ends stable, or is refused with a reason."""

import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.studies.stability.chain_runs import run_chain
from bedchain.studies.stability.chain_settings import WalkerWindow, chain_settings
from bedchain.studies.stability.settings import ON
from bedchain.studies.stability.verdict import INACCURATE, REFUSED, STABLE
from bedchain.studies.stability.walkers import HEIGHT, WIDTH
from bedchain.trajectory.grid import Grid

REDUCED = {item.name: item for item in chain_settings() if item.reduced}
WITH_GUARDS = [name for name, item in REDUCED.items() if item.guards == ON]


@pytest.mark.parametrize("name", WITH_GUARDS)
def test_a_chain_at_an_extreme_is_stable_or_says_why_not(name, tmp_path):
    setting = REDUCED[name]
    found = setting.run(tmp_path, {})
    beyond = setting.group == "chain window" and setting.limit.share > 1
    # A chain that jumps between frames needs some that are far apart
    jumps = setting.group == "chain window" and setting.values["model"] == "recurrence"
    if beyond or (jumps and found.outcome == REFUSED):
        assert found.outcome == REFUSED and len(found.reason) > 20
    else:
        assert found.outcome == STABLE, found


def test_the_guard_against_traps_is_needed(tmp_path):
    name = "cell entered in the last frame, static"
    assert REDUCED[name].run(tmp_path, {}).outcome == STABLE
    found = REDUCED[f"{name}, guard off"].run(tmp_path, {})
    # All particles end in a cell that one of them entered once
    assert found.outcome == INACCURATE and found.quantity.startswith("long-run density")
    assert found.value > 0.99


class Leaky:
    """A chain that loses one particle in a hundred each step, in all that it gives."""

    def __init__(self, chain):
        self.chain, self.grid = chain, chain.grid

    def __getattr__(self, name):
        return getattr(self.chain, name)

    def densities(self, start, marked, steps, rng=None):
        kept = 0.99 ** np.array(steps)[:, None, None]
        found = self.chain.densities(start, marked, steps, rng) * kept
        return found if rng is None else found.astype(np.int64)


@pytest.mark.parametrize("model", ["static", "jump"])
def test_a_chain_that_loses_mass_is_seen(model):
    def leaky(*arguments, **options):
        return Leaky(registry.learn(*arguments, **options))

    found = run_chain(model, WalkerWindow(columns=2, rows=2, steps=3).case, leaky)
    assert found.outcome == INACCURATE
    assert found.quantity in ("mass lost [1]", "particles lost by a Monte Carlo [1]")


def test_probabilities_that_do_not_sum_to_one_are_refused():
    def wrong(*arguments, **options):
        chain = registry.learn(*arguments, **options)
        chain.matrix.data[0] += 1e-6
        return chain

    found = run_chain("static", WalkerWindow(columns=2, rows=2, steps=3).case, wrong)
    assert found.outcome == REFUSED and "off a sum of 1" in found.reason


@pytest.mark.parametrize("name", list(registry.LEARNERS))
def test_a_step_that_is_asked_for_twice_is_given_twice(name):
    one = WalkerWindow(columns=2, rows=2).case()
    options = {"separation_s": 0.1, "coarse_m": 0.01} if name == "recurrence" else {}
    chain = registry.learn(name, one.frames, Grid(WIDTH, HEIGHT, 2, 2), **options)
    everyone = np.ones((1, 400), bool)
    for rng in (None, np.random.default_rng(1)):
        found = chain.densities(one.start, everyone, [0, 3, 3], rng)
        assert (found[1] == found[2]).all() and found[1].sum() == pytest.approx(400)
