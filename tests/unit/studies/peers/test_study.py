# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison with other codes: constants of their contact laws, their files and logs, the study."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from bedchain.errors import UserError
from bedchain.studies.peers import bedfoam
from bedchain.studies.peers.bed import with_numbers
from bedchain.studies.peers.study import (
    all_peers,
    busy_time,
    compare,
    duration_for,
    missing,
    record_file,
    run_in_turns,
)
from bedchain.studies.peers.table import markdown, ratios, summary
from made import ROOT
from made.peers import timed_peer


def test_a_slow_code_simulates_less(bed, tmp_path):
    peer = timed_peer("slow", [1.0], tmp_path, [])
    # 1e-6 s a particle's step, three particles, 50 000 steps a second: 0.15 s a simulated second
    assert duration_for(peer, bed, 0.02, 75.0) == 0.02
    assert duration_for(peer, bed, 0.02, 0.0015) == pytest.approx(0.01)


def test_codes_take_turns_and_what_is_done_stays_done(bed, tmp_path):
    calls, own = [], tmp_path / "own"
    own.write_text("deck")
    peers = [timed_peer(name, [1.0, 3.0, 2.0], own, calls, gas=True) for name in ("a", "b")]
    first = run_in_turns(bed, peers, tmp_path, 2, 0.01, 75.0, lambda line: None)
    assert calls == ["a", "b", "a", "b"]
    again = run_in_turns(bed, peers, tmp_path, 3, 0.01, 75.0, lambda line: None)
    assert calls[4:] == ["a", "b"]
    assert again[:4] == first
    assert not list((tmp_path / "box" / "work").glob("[!.]*"))


@pytest.mark.parametrize("changed", ["deck", "particles", "number", "duration"])
def test_a_changed_input_makes_a_run_of_its_own(bed, tmp_path, changed):
    own = tmp_path / "own"
    own.write_text("deck")
    peer = timed_peer("a", [1.0], own, [])
    before = record_file(tmp_path, bed, peer, 0.01, 1)
    assert record_file(tmp_path, bed, peer, 0.01, 1) == before
    duration = 0.02 if changed == "duration" else 0.01
    if changed == "deck":
        own.write_text("another deck")
    elif changed == "particles":
        bed = replace(bed, particles=bed.particles + 1e-9)
    elif changed == "number":
        bed = replace(bed, parameters=with_numbers(bed.parameters, friction=0.2))
    assert record_file(tmp_path, bed, peer, duration, 1) != before


def test_a_code_that_is_not_there_or_fails_leaves_a_note_and_the_study_goes_on(bed, tmp_path):
    calls, said = [], []
    absent = replace(
        timed_peer("absent", [], tmp_path / "x", calls), program="no-such-program", package="absent-dem"
    )
    broken = timed_peer("broken", [], tmp_path / "x", calls, fails=True)
    well = timed_peer("bedFoam", [2.0], tmp_path / "x", calls, gas=True)
    runs = run_in_turns(bed, [absent, broken, well], tmp_path, 1, 0.01, 75.0, said.append)
    assert calls == ["broken", "bedFoam"]
    assert "apt-get install --no-install-recommends absent-dem" in said[0]
    table = summary(runs, {"box": bed}, [absent, broken, well]).set_index("code")
    assert "not installed" in table.loc["absent", "note"]
    assert table.loc["broken", "note"].startswith("failed: broken has stopped")
    assert table["repeats"].to_dict() == {"absent": 0, "broken": 0, "bedFoam": 1}
    text = markdown(table.reset_index(), ratios(table.reset_index()))
    assert "- absent: absent is not installed" in text and "| bedFoam | 200" in text


def test_time_of_other_programs():
    # user, nice, system, idle, waiting, two interrupts, stolen; guests are in user
    text = "cpu  100 10 20 5000 300 1 2 3 40 50\ncpu0 1 2 3\n"
    assert busy_time(text) == pytest.approx(136 / os.sysconf("SC_CLK_TCK"))


def test_every_code_names_its_files_and_its_program():
    peers = all_peers(ROOT / "results/bin/bedFoam")
    assert [peer.name for peer in peers] == [
        *("bedFoam", "bedFoam, 2 ranks", "DPMFoam", "LIGGGHTS", "LAMMPS GRANULAR", "Yade"),
    ]
    for peer in peers:
        assert all((ROOT / file).exists() for file in peer.files if file.name != "bedFoam")
    assert "snakemake" in missing(bedfoam.peers(Path("nowhere/bedFoam"))[0])


def test_a_missing_solver_or_case_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(UserError, match="there is no solver .*build_solver"):
        compare(["short"], tmp_path, tmp_path / "bedFoam", 1, 0.01, 75.0)
    (tmp_path / "bedFoam").touch()
    with pytest.raises(UserError, match="there is no case shorter"):
        compare(["shorter"], tmp_path, tmp_path / "bedFoam", 1, 0.01, 75.0)
    with pytest.raises(UserError, match="--repeats 0: must be above 0"):
        compare(["short"], tmp_path, tmp_path / "bedFoam", 0, 0.01, 75.0)


def test_packages_of_the_codes_stand_in_one_file():
    listed = [line.split("#")[0].strip() for line in (ROOT / "envs/apt_peers.txt").read_text().splitlines()]
    needed = {peer.package for peer in all_peers(ROOT) if peer.package}
    base = (ROOT / "envs/apt.txt").read_text().split()
    assert needed <= {*listed, *base} and not {*filter(None, listed)} & {*base}
