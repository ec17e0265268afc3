# SPDX-License-Identifier: GPL-3.0-or-later
"""The run of a variant: its case checked first, then the two commands with its times."""

from pathlib import Path

import pytest

from bedchain.case.variants import Variant
from bedchain.dem import variant_run
from bedchain.errors import CaseError
from made.case_text import changed_case


@pytest.fixture
def commands(monkeypatch):
    """No solver runs: commands are noted."""
    noted = []
    monkeypatch.setattr(variant_run, "run_logged", lambda command, log: noted.append(command[1:]))
    return noted


def test_a_variant_runs_up_to_the_end_of_its_own_case(tmp_path, commands):
    folder = tmp_path / "variant"
    case = variant_run.simulate(changed_case(tmp_path), Variant("v", {"time.end_s": 6.0}), folder, ranks=2)
    assert case["time"]["end_s"] == 6.0
    (writer, *files), (runner, *options) = commands
    assert [Path(writer).stem, Path(runner).stem] == ["write_parameters", "run_dem"]
    assert files == [str(folder / "case.yaml"), str(folder)]
    assert options == [str(folder), "--end", "6.0", "--segment", "0.5", "--ranks", "2"]


def test_a_case_that_cannot_be_runs_nothing(tmp_path, commands):
    with pytest.raises(CaseError, match="bed.width_m"):
        variant_run.simulate(
            changed_case(tmp_path), Variant("v", {"bed.width_m": -1.0}), tmp_path / "variant"
        )
    assert commands == []
