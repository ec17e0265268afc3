# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages: every fault of a network names file, chain and state."""

import copy
from pathlib import Path

import pytest

from bedchain.case.load import load_case
from bedchain.chains.networks.page import chains_of, starts_and_exits
from bedchain.errors import UserError

PAGE = """
title: two tanks
network:
  chains:
    - name: plant
      fluxes:
        states: [{name: a, content: 2}, {name: b, content: 4, height_m: 1}]
        exits: [out]
        feed: {a: 1}
        moves: [{from: a, to: b, flow: 3}, {from: b, to: a, flow: 2}, {from: b, to: out, flow: 1}]
      start: {b: 1}
    - name: mixer
      static_mixer: {rows: 4, steps: 3, down_1: 0.3, up_1: 0.2}
  mixtures:
    - {name: both, key: mixer, others: [mixer]}
"""


@pytest.fixture
def section(tmp_path):
    (tmp_path / "case.yaml").write_text(PAGE)
    return copy.deepcopy(load_case(tmp_path / "case.yaml")["network"])


def test_a_page_gives_its_chains(section):
    plant, mixer = chains_of(section, "case.yaml")
    assert plant.network.open_chain.residence()[0] == pytest.approx(6) and plant.start.tolist() == [0, 1]
    assert mixer.start.tolist() == [0.5, 0.5, 0, 0] and mixer.network.step_s == 1
    assert starts_and_exits(section, Path()) == (True, True)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda page: page["chains"][0]["fluxes"]["moves"].pop(),
         "x, chain plant: the flows of b do not balance"),
        (lambda page: page["chains"][0]["fluxes"]["states"][0].update(content=0.0),
         "chain plant: state a has the content 0"),
        (lambda page: page["chains"][0]["fluxes"].update(step_s=2.0),
         "chain plant: the rates out of a sum to 1.5"),
        (lambda page: page["chains"][0].update(start={"c": 1}), "start names c, which is no state"),
        (lambda page: page["mixtures"][0].update(others=["mixr"]),
         "there is no chain mixr; did you mean mixer"),
        (lambda page: page["mixtures"][0].update(others=["plant"]), "plant has other states than mixer"),
        (lambda page: (page["chains"][0].pop("start"), page["mixtures"][0].update(others=["plant"])),
         "plant has no start"),
    ],
)  # fmt: skip
def test_faults_name_file_chain_and_state(section, change, message):
    change(section)
    with pytest.raises(UserError, match=message):
        chains_of(section, "x")


def test_declared_contents_that_moves_do_not_hold_are_refused(section):
    edges = {
        "states": [{"name": "a", "content": 3.0}],
        "exits": ["out"],
        "feed": {"a": 1.0},
        "moves": [
            {"from": "a", "to": "a", "probability_1": 0.5},
            {"from": "a", "to": "out", "probability_1": 0.5},
        ],
    }
    section["chains"] = [{"name": "tank", "edges": edges, "show": True}]
    section["mixtures"] = []
    with pytest.raises(UserError, match="state a has the declared content 3, but .* hold 2"):
        chains_of(section, "x")
