# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory that a case needs, and a machine too small for it."""

import pytest

from bedchain.dem import memory
from bedchain.dem.memory import machine_bytes, memory_needs, require_memory
from bedchain.errors import UserError


def test_the_paper_s_bed_needs_less_than_a_gigabyte(paper):
    needs = memory_needs(paper)
    assert 300e6 < needs["the simulation"] < 1e9
    assert 300e6 < needs["learning the chains"] < 1e9
    require_memory(paper)


def test_memory_grows_with_particles_gas_cells_and_frames(paper):
    usual = memory_needs(paper)
    many = memory_needs(paper | {"particles": paper["particles"] | {"number": 10_000_000}})
    assert many["the simulation"] - usual["the simulation"] == pytest.approx(1.7e3 * (1e7 - 81000))
    fine = memory_needs(paper | {"gas": paper["gas"] | {"cell_size_m": 1e-3}})
    assert fine["the simulation"] > usual["the simulation"] + 400e6
    alike = memory_needs(paper | {"chain": paper["chain"] | {"models": ["recurrence"]}})
    assert alike["learning the chains"] - usual["learning the chains"] == 8 * 200**2


def test_a_case_too_large_for_the_machine_is_refused_with_both_sizes(paper, monkeypatch):
    monkeypatch.setattr(memory, "machine_bytes", lambda: 2e8)
    with pytest.raises(
        UserError, match=r"learning the chains needs about [\d.]+MB of memory, this machine has 200MB"
    ):
        require_memory(paper)


def test_a_group_of_processes_may_have_less_than_the_machine(tmp_path, monkeypatch):
    for text, factor in (("max", 1), ("1000", 0)):
        (tmp_path / "memory.max").write_text(f"{text}\n")
        monkeypatch.setattr(memory, "GROUPS", (str(tmp_path / "memory.max"),))
        assert (machine_bytes() == 1000) == (factor == 0)
