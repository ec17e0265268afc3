# SPDX-License-Identifier: GPL-3.0-or-later
"""Results kept from one run to the next."""

import pytest

from bedchain.errors import UserError
from bedchain.studies.records import record_of, remembered, remove_other_results, stamp


def test_a_stamp_changes_with_data_and_settings_and_old_results_go(tmp_path):
    file = tmp_path / "data"
    file.write_bytes(b"1")
    first = stamp([file], {"lag": 1})
    assert stamp([file], {"lag": 1}) == first and stamp([file], {"lag": 2}) != first
    file.write_bytes(b"2")
    assert stamp([file], {"lag": 1}) != first
    record_of(remove_other_results(tmp_path / "kept" / first), "static 40").write_text("x")
    remove_other_results(tmp_path / "kept" / "new")
    assert [folder.name for folder in (tmp_path / "kept").iterdir()] == ["new"]


def test_what_is_no_record_stays_beside_the_records(tmp_path):
    """A user's notes among old records, folders of other names, and a link to a folder elsewhere."""
    old, elsewhere, here = "0123456789abcdef", tmp_path / "elsewhere", tmp_path / "kept"
    for folder in (here / old, here / "my thesis", elsewhere):
        folder.mkdir(parents=True)
        record_of(folder, "static 40").write_text("{}")
    (here / old / "notes.txt").write_text("x")
    (here / "fedcba9876543210").symlink_to(elsewhere)
    remove_other_results(here / "new")
    assert [file.name for file in (here / old).iterdir()] == ["notes.txt"]
    assert record_of(here / "my thesis", "static 40").exists() and record_of(elsewhere, "static 40").exists()


def test_a_result_is_made_once_and_a_failure_is_not_kept(tmp_path):
    record, made = record_of(tmp_path / "new", "static 40"), []

    def fail():
        raise UserError("no")

    with pytest.raises(UserError):
        remembered(record, fail)
    assert not record.exists()
    for _ in range(2):
        assert remembered(record, lambda: made.append(1) or {"rms": 0.5}) == {"rms": 0.5}
    assert made == [1]
    assert record_of(tmp_path / "new", "static 41") != record


@pytest.mark.parametrize("damaged", ["", '{"rms": 0.', "\0\0"])
def test_a_damaged_record_is_made_again(tmp_path, damaged):
    record = record_of(tmp_path, "static 40")
    record.write_text(damaged)
    assert remembered(record, lambda: {"rms": 0.5}) == {"rms": 0.5}
    assert remembered(record, lambda: None) == {"rms": 0.5}
