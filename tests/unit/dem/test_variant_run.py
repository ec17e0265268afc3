# SPDX-License-Identifier: GPL-3.0-or-later
"""The run of a variant: its case checked first, then a process of its own with the times of its case."""

import sys

import pytest

from bedchain.case.variants import Variant
from bedchain.dem import variant_run
from bedchain.errors import CaseError
from made.case_text import changed_case


def test_a_variant_runs_in_a_process_that_finds_this_library(tmp_path, monkeypatch):
    calls = []
    monkeypatch.setattr(
        variant_run, "run_logged", lambda command, log, variables: calls.append((command, variables))
    )
    monkeypatch.setenv("PYTHONPATH", "elsewhere")
    folder = tmp_path / "variant"
    case = variant_run.simulate(changed_case(tmp_path), Variant("v", {"time.end_s": 6.0}), folder, ranks=2)
    ((command, variables),) = calls
    assert case["time"]["end_s"] == 6.0
    assert command == [sys.executable, "-m", "bedchain.dem.variant_run", str(folder), "2"]
    first, *others = variables["PYTHONPATH"].split(":")
    assert (variant_run.LIBRARY / "bedchain" / "dem").is_dir() and first == str(variant_run.LIBRARY)
    assert others == ["elsewhere"]


def test_that_process_simulates_up_to_the_end_of_its_own_case(tmp_path, monkeypatch):
    calls = []
    monkeypatch.setattr(variant_run, "write_parameters", lambda *paths: calls.append(paths))
    monkeypatch.setattr(variant_run, "run_dem", lambda *arguments: calls.append(arguments))
    changed_case(tmp_path, ("end_s: 5.0  # simulated", "end_s: 6.0"))
    variant_run.run_variant(tmp_path, 2)
    assert calls == [(tmp_path / "case.yaml", tmp_path), (tmp_path, 6.0, 0.5, 2)]


def test_a_case_that_cannot_be_runs_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(variant_run, "run_logged", lambda *_: pytest.fail("it was run"))
    with pytest.raises(CaseError, match="bed.width_m"):
        variant_run.simulate(
            changed_case(tmp_path), Variant("v", {"bed.width_m": -1.0}), tmp_path / "variant"
        )
