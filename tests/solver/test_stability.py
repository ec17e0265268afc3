# SPDX-License-Identifier: GPL-3.0-or-later
"""The reduced stability study by the real solvers: every kind of end, and guards that are needed."""

import pytest

import study_stability as stage
from bedchain.studies.stability.bed_settings import bed_settings
from bedchain.studies.stability.settings import ON, is_of_chains
from bedchain.studies.stability.verdict import DIVERGED, FAULTS, INACCURATE, REFUSED, STABLE
from made import ROOT

LONGEST_S = 600.0  # on a busy machine; seconds on an idle one
GROUPS = sorted({setting.group for setting in bed_settings()})


@pytest.fixture(scope="module")
def study(solver, tmp_path_factory):
    """Folder and table of the reduced set."""
    folder = tmp_path_factory.mktemp("stability")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        table = stage.study_stability(folder, "reduced", GROUPS, LONGEST_S)
    return folder, table.set_index("setting")


def test_every_kind_of_end_comes_and_none_is_a_fault(study):
    _, table = study
    assert not table["outcome"].isin(FAULTS).any(), table[["outcome", "reason"]].to_string()
    assert {STABLE, REFUSED, DIVERGED, INACCURATE} == set(table["outcome"])
    as_they_come = table[table["guards"] == ON]
    assert (as_they_come["outcome"] != INACCURATE).all(), as_they_come["reason"].to_string()


def test_what_is_refused_names_the_key_and_what_is_stopped_the_place(study):
    _, table = study
    refused, stopped = (table[table["outcome"] == outcome] for outcome in (REFUSED, DIVERGED))
    assert refused["guard"].str.match(r"check of \w+\.\w+").all()
    assert (refused["reason"].str.len() > 20).all()
    placed = stopped[stopped["guard"] != "lost particle while settling"]
    assert len(placed) and placed[["time_s", "x_m", "z_m"]].notna().all(axis=None)


def test_a_guard_is_needed(study):
    _, table = study
    for name in table.index[table["guards"] != ON]:
        assert table.loc[name, "outcome"] in (INACCURATE, DIVERGED)
        with_guard = table.loc[name.removesuffix(", guard off")]
        assert with_guard["outcome"] in (REFUSED, DIVERGED)
    # The same two spheres: refused, or flung apart with more than they came with
    fast = table.loc["E 1e+06 Pa, step 100 % of a collision, guard off"]
    assert fast["outcome"] == INACCURATE and fast["value"] > 1


def test_a_study_that_is_run_again_does_nothing(study, monkeypatch):
    folder, table = study
    monkeypatch.chdir(ROOT)
    kept = {file: file.stat().st_mtime_ns for file in (folder / "kept").rglob("*.json")}
    again = stage.study_stability(folder, "reduced", GROUPS, LONGEST_S).set_index("setting")
    assert again["wall_s"].tolist() == table["wall_s"].tolist()
    assert kept == {file: file.stat().st_mtime_ns for file in (folder / "kept").rglob("*.json")}
    assert len(kept) == len(table)


def test_maps_and_table_are_there(study):
    folder, table = study
    assert (folder / "stability.csv").exists()
    made = {file.name for file in (folder / "figures").iterdir()}
    assert {"steps.png", "steps.pdf", "steps.csv", "others.png", "gas_steps.png"} <= made
    assert not any(is_of_chains(group) for group in table["group"])
