# SPDX-License-Identifier: GPL-3.0-or-later
"""The figure of the comparison."""

from bedchain.studies.peers.plots import draw
from bedchain.studies.peers.study import (
    run_in_turns,
)
from bedchain.studies.peers.table import summary
from made.peers import timed_peer


def test_the_table_can_be_drawn(bed, tmp_path):
    peers = [
        timed_peer("bedFoam", [1.0], tmp_path / "x", [], gas=True),
        timed_peer("alone", [0.5], tmp_path / "x", []),
    ]
    runs = run_in_turns(bed, peers, tmp_path, 1, 0.01, 75.0, lambda line: None)
    draw(summary(runs, {"box": bed}, peers), tmp_path / "figures" / "peers")
    assert {file.name for file in (tmp_path / "figures").iterdir()} == {"peers.png", "peers.pdf"}
