# SPDX-License-Identifier: GPL-3.0-or-later
"""The gas's case of a segment: made anew, taken over from the segment before, or cut for other ranks."""

import pytest

from bedchain.dem import gas_case
from made import ROOT

SETTINGS = {"ranks": 1, "deck": "in.fluidize"}


@pytest.fixture
def commands(monkeypatch):
    """OpenFOAM's tools are not run: their commands are noted."""
    noted = []
    monkeypatch.setattr(gas_case, "run_logged", lambda command, log: noted.append(command[0]))
    monkeypatch.chdir(ROOT)
    return noted


def write_case(folder, *times, ranks=1):
    """A case with a time folder each in itself, or in each rank's part."""
    for name in ("constant", "system"):
        (folder / name).mkdir(parents=True)
        (folder / name / "file").write_text(name)
    (folder / "caseParameters").write_text("diameter 1;")
    (folder / "segmentParameters").write_text('deck "in.fluidize";\nranks 1;\n')
    for part in [folder] if ranks == 1 else [folder / f"processor{rank}" for rank in range(ranks)]:
        (part / "constant").mkdir(parents=True, exist_ok=True)
        for time in times:
            (part / time).mkdir()
            (part / time / "U").write_text(f"{part.name} {time}")


def test_the_last_time_is_the_largest_number(tmp_path):
    for name in ("0", "0.5", "10", "9.75", "constant", "10.orig"):
        (tmp_path / name).mkdir()
    (tmp_path / "11").write_text("a file")
    assert gas_case.last_time(tmp_path).name == "10"
    assert gas_case.last_time(tmp_path / "constant") is None


@pytest.mark.parametrize(("ranks", "tools"), [(1, ["blockMesh"]), (2, ["blockMesh", "decomposePar"])])
def test_a_first_segment_gets_a_mesh(tmp_path, commands, ranks, tools):
    (tmp_path / "caseParameters").write_text("diameter 1;")
    gas = tmp_path / "gas"
    gas_case.prepare_gas(gas, tmp_path / "caseParameters", tmp_path / "none", SETTINGS | {"ranks": ranks})
    assert commands == tools and (gas / "0" / "p").exists() and (gas / "system" / "controlDict").exists()
    assert (gas / "segmentParameters").read_text() == f'ranks {ranks};\ndeck "in.fluidize";\n'
    assert (gas / "caseParameters").read_text() == "diameter 1;"


def test_a_later_segment_goes_on_from_the_last_fields(tmp_path, commands):
    write_case(tmp_path / "before" / "gas", "0", "0.5")
    (tmp_path / "caseParameters").write_text("diameter 2;")
    gas = tmp_path / "gas"
    gas_case.prepare_gas(gas, tmp_path / "caseParameters", tmp_path / "before", SETTINGS)
    assert commands == []
    assert {item.name for item in gas.iterdir() if item.is_dir()} == {"constant", "system", "0.5"}
    assert (gas / "caseParameters").read_text() == "diameter 2;"


@pytest.mark.parametrize(
    ("before", "after", "tools"),
    [
        (1, 1, []),
        (2, 2, []),
        (1, 2, ["decomposePar"]),
        (2, 1, ["reconstructPar"]),
        (2, 3, ["reconstructPar", "decomposePar"]),
    ],
)
def test_a_repeat_on_other_ranks_is_put_together_and_cut(tmp_path, commands, before, after, tools):
    write_case(tmp_path / "before", "0.5", ranks=before)
    gas_case.copy_last_state(tmp_path / "before", tmp_path / "gas")
    gas_case.redistribute(tmp_path / "gas", tmp_path / "before", after)
    assert commands == tools
    parts = sorted(item.name for item in (tmp_path / "gas").glob("processor*"))
    assert parts == ([f"processor{rank}" for rank in range(before)] if before == after > 1 else [])
    if tools:
        assert (
            tmp_path / "gas" / "segmentParameters"
        ).read_text() == f'deck "in.fluidize";\nranks {after};\n'
