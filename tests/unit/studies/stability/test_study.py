# SPDX-License-Identifier: GPL-3.0-or-later
"""How settings are judged, the limits by theory, and a study that goes on whatever its settings do."""

import os
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.lifetime import child_ends_with_parent
from bedchain.studies.stability.settings import StabilitySetting
from bedchain.studies.stability.study import limited, run_study
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import (
    CRASHED,
    HUNG,
    STABLE,
    Verdict,
)


def test_a_setting_that_hangs_is_ended_with_all_that_it_started(tmp_path):
    noted = tmp_path / "pid"

    def hang():
        child = subprocess.Popen(["sleep", "600"], preexec_fn=child_ends_with_parent())
        noted.write_text(str(child.pid))
        child.wait()

    assert limited(hang, 1.0).outcome == HUNG
    for _ in range(100):
        if not Path(f"/proc/{noted.read_text()}").exists():
            break
        time.sleep(0.1)
    assert not Path(f"/proc/{noted.read_text()}").exists()


def test_a_setting_that_breaks_is_a_verdict_and_a_users_error_is_told():
    assert "code 3" in limited(lambda: os._exit(3), 60).reason
    broken = limited(lambda: 1 / 0, 60)
    assert broken.outcome == CRASHED and "ZeroDivisionError" in broken.reason

    def absent():
        raise UserError("the program liggghts is not installed")

    with pytest.raises(UserError, match="not installed"):
        limited(absent, 60)


def setting(name, run, group="made up", inputs="1", **more):
    """A setting that does what it is told."""
    return StabilitySetting(group, name, {"x_1": 1.0}, Limit("x [1]", 2.0, "x < 2", 1.0), run, inputs, **more)


def noting(file, verdict):
    """What a setting runs: notes each call in a file, and gives a verdict."""

    def run(folder, known):
        folder.mkdir(parents=True)
        with file.open("a") as stream:
            stream.write("called\n")
        return verdict

    return run


def test_a_study_goes_on_after_failures_and_does_nothing_twice(tmp_path):
    notes = tmp_path / "notes"
    good = Verdict(STABLE, observed={"a_1": 1.0})
    settings = [
        setting("fails", lambda folder, known: 1 / 0),
        setting("works", noting(notes, good)),
        setting("needs", lambda folder, known: Verdict(STABLE, value=known["works"]["a_1"]), needs="works"),
    ]
    source = tmp_path / "source"
    source.write_text("one")
    sources, said = {"made up": [source]}, []
    table = run_study(settings, tmp_path / "study", sources, said.append)
    assert list(table["outcome"]) == [CRASHED, STABLE, STABLE] and table["value"].iloc[2] == 1.0
    assert list(table["over_limit_1"]) == [0.5] * 3
    assert len(said) == 3 and "3 of 3" in said[-1] and "left" in said[-1]
    assert (tmp_path / "study" / "work").exists() and not (tmp_path / "study" / "work" / "works").exists()
    again = run_study(settings, tmp_path / "study", sources, said.append)
    pd.testing.assert_frame_equal(again, table)
    assert notes.read_text().count("called") == 1
    run_study([replace(settings[1], inputs="2")], tmp_path / "study", sources, said.append)
    source.write_text("two")
    run_study([settings[1]], tmp_path / "study", sources, said.append)
    assert notes.read_text().count("called") == 3
