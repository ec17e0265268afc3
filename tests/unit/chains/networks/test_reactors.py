# SPDX-License-Identifier: GPL-3.0-or-later
"""Reactors as chains tend to their closed forms with the first power of their cells."""

import pytest

from bedchain.chains.networks import reactors
from bedchain.errors import DataError, UserError

BED = {
    "height_m": 1.0,
    "velocity_m_s": 0.1,
    "minimum_m_s": 0.006,
    "bubble_diameter_m": 0.04,
    "rate_1_s": 10.0,
}
GRAINS = reactors.Grains(0.55, 0.6, 0.005, 2e-5)
CHAINS = {
    "dispersed": lambda cells: reactors.tanks(cells, 1.0, 2.0, 20.0),
    "mixed": lambda cells: reactors.mixed_emulsion(cells, 0.8, 2.0, 1.0),
    "two": lambda cells: reactors.two_phases(reactors.Bubbles(cells, **BED), 1.2),
    "three": lambda cells: reactors.three_phases(reactors.Bubbles(cells, **BED), GRAINS),
}


def reacted(network):
    return network.open_chain.exit_shares()[network.exits.index("reacted")]


@pytest.mark.parametrize("name", CHAINS)
def test_conversion_tends_to_the_closed_form(name):
    errors = []
    for cells in (40, 80, 160):
        network, closed = CHAINS[name](cells)
        errors.append(abs(reacted(network) - closed["conversion_closed_form"]))
    assert errors[2] < 4e-3 and errors[0] > 1.7 * errors[1] > 2.9 * errors[2]


def test_tanks_react_exactly():
    network, closed = reactors.tanks(7, 3.0, 0.5, None)
    assert reacted(network) == pytest.approx(closed["conversion_closed_form"], abs=1e-13)


def test_a_tracer_has_the_variance_of_a_closed_vessel():
    network, closed = reactors.tanks(400, 1.0, 0.0, 20.0)
    mean, variance = network.open_chain.residence()
    assert mean == pytest.approx(1)
    assert variance == pytest.approx(closed["relative_variance_closed_form"], abs=1e-3)


def test_too_few_cells_for_a_peclet_number_are_refused():
    with pytest.raises(DataError, match="4 cells disperse more than Pe 20 asks: take at least 10"):
        reactors.tanks(4, 1.0, 0.0, 20.0)


def test_slow_bubbles_have_no_clouds():
    slow = BED | {"minimum_m_s": 0.7, "velocity_m_s": 1.5, "bubble_diameter_m": 0.01}
    with pytest.raises(UserError, match="regime"):
        reactors.three_phases(reactors.Bubbles(10, **slow), GRAINS)
