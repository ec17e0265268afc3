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
    (remove_other_results(tmp_path / "kept" / first) / "result").write_text("x")
    remove_other_results(tmp_path / "kept" / "new")
    assert [folder.name for folder in (tmp_path / "kept").iterdir()] == ["new"]


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
