# SPDX-License-Identifier: GPL-3.0-or-later
"""Archives that do not fit their case or are not as they were made; packing is in tests/solver."""

import hashlib
import json
import os

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema
from bedchain.errors import UserError
from bedchain.trajectory.archive import (
    check_archive,
    check_files,
    file_hash,
    keys_hash,
    read_provenance,
    solver_keys,
)
from made.case_text import changed_case

SCHEMA = load_schema()
# 0.09 x 0.45 m in 10 x 50 cells of 9 mm
LEVEL = 1e-3
# the windows of the case, from 1 to 5 s, and 0.25 s before them
FRAMES = 171


@pytest.fixture
def case(tmp_path):
    """The case of the archive."""
    return load_case(changed_case(tmp_path))


@pytest.fixture
def folder(case, tmp_path):
    """An archive of the case with one file of data."""
    folder = tmp_path / "reference"
    folder.mkdir()
    (folder / "positions.xz").write_bytes(b"positions")
    data = {"bytes": 9, "sha256": hashlib.sha256(b"positions").hexdigest()}
    write(
        folder, solver_keys=solver_keys(case, SCHEMA), start_s=1.0, end_s=5.0, history_s=0.25,
        n_frames=FRAMES, repeats=1, level_m=LEVEL, files={"positions.xz": data},
    )  # fmt: skip
    return folder


def write(folder, **values):
    (folder / "provenance.json").write_text(json.dumps(values))


def rewritten(folder, **values):
    write(folder, **json.loads((folder / "provenance.json").read_text()) | values)


def with_keys(case, section, **keys):
    return case | {section: case[section] | keys}


def test_its_own_case_is_served(folder, case):
    assert check_archive(folder, case, SCHEMA)["n_frames"] == FRAMES


@pytest.mark.parametrize(
    ("section", "keys", "message"),
    [
        ("gas", {"drag_law": "di_felice"}, "gas.drag_law is 'di_felice' and was 'gidaspow'.*another bed"),
        ("gas", {"cell_size_m": 0.009}, "gas.cell_size_m is 0.009 and was 0.005"),
        ("contact", {"friction_1": 0.2}, "contact.friction_1 is 0.2 and was 0.1"),
        ("learning", {"start_s": 0.25}, "learning.start_s is 0.25 s, the archive holds 1 to 5 s"),
        ("cells", {"columns": 8}, "cells.columns 8: 0.09 m .* no multiple of 0.001 m.*divisor of 90"),
        ("cells", {"rows": 40}, "cells.rows 40"),
        ("mixing", {"split_z_m": 0.0605}, "mixing.split_z_m is 0.0605 m, no multiple of 0.001 m"),
        ("comparison", {"repeats": 2}, "comparison.repeats is 2, the archive holds 1"),
    ],
)
def test_another_case_window_or_grid_is_refused(folder, case, section, keys, message):
    with pytest.raises(UserError, match=f"(?s)does not serve.*{message}.*reference=simulate"):
        check_archive(folder, with_keys(case, section, **keys), SCHEMA)


def test_keys_that_no_solver_needs_may_change(folder, case):
    for section, keys in (("chain", {"lag_s": 0.05}), ("run", {"ranks": 1}), ("cells", {"columns": 45})):
        other = with_keys(case, section, **keys)
        assert other != case
        assert check_archive(folder, other, SCHEMA)["solver_keys"] == solver_keys(case, SCHEMA)


def test_a_key_younger_than_the_archive_must_have_its_default(folder, case):
    keys = solver_keys(case, SCHEMA)
    # the second has the diameter for its default
    old = {key: keys[key] for key in keys.keys() - {"contact.friction_1", "bed.thickness_m"}}
    rewritten(folder, solver_keys=old)
    assert check_archive(folder, case, SCHEMA)["solver_keys"] == old
    with pytest.raises(UserError, match=r"contact.friction_1 is 0.2; the archive is older"):
        check_archive(folder, with_keys(case, "contact", friction_1=0.2), SCHEMA)
    with pytest.raises(UserError, match=r"bed.thickness_m is 0.002; the archive is older"):
        check_archive(folder, with_keys(case, "bed", thickness_m=0.002), SCHEMA)


def test_an_archive_with_frames_left_out_is_refused(folder, case):
    rewritten(folder, n_frames=FRAMES - 8)
    with pytest.raises(UserError, match=f"{FRAMES - 8} frames of {FRAMES}: the simulation was not finished"):
        check_archive(folder, case, SCHEMA)


def test_a_missing_shorter_or_changed_file_is_refused(folder):
    file, provenance = folder / "positions.xz", read_provenance(folder)
    check_files(folder, provenance)
    file.write_bytes(b"posItions")
    with pytest.raises(UserError, match="positions.xz is corrupted.*git checkout"):
        check_files(folder, provenance)
    file.write_bytes(b"position")
    with pytest.raises(UserError, match="positions.xz has 8 bytes, 9 expected"):
        check_files(folder, provenance)
    file.unlink()
    with pytest.raises(UserError, match="positions.xz is missing"):
        check_files(folder, provenance)


@pytest.mark.parametrize("text", ["{}", "{", "[1]"])
def test_what_is_no_archive_is_refused(folder, text):
    (folder / "provenance.json").write_text(text)
    with pytest.raises(UserError, match="no readable archive"):
        read_provenance(folder)


def test_hashes_know_contents_and_not_their_order(tmp_path):
    assert keys_hash({"a": 1, "b": 2}) == keys_hash({"b": 2, "a": 1}) != keys_hash({"a": 1, "b": 3})
    (tmp_path / "file").write_bytes(b"positions")
    assert file_hash(tmp_path / "file") == hashlib.sha256(b"positions").hexdigest()


def test_files_of_an_archive_stay_in_its_folder(folder):
    data = json.loads((folder / "provenance.json").read_text())["files"]["positions.xz"]
    for name, message in (
        ("../case.yaml", "not within this folder"),
        ("/etc/passwd", "not within this folder"),
    ):
        rewritten(folder, files={name: data})
        with pytest.raises(UserError, match=message):
            check_files(folder, read_provenance(folder))


def test_special_files_of_an_archive_are_refused(folder):
    (folder / "positions.xz").unlink()
    os.mkfifo(folder / "positions.xz")
    with pytest.raises(UserError, match="positions.xz is a special file"):
        check_files(folder, read_provenance(folder))
    (folder / "provenance.json").unlink()
    os.mkfifo(folder / "provenance.json")
    with pytest.raises(UserError, match="provenance.json is a special file"):
        read_provenance(folder)
