# SPDX-License-Identifier: GPL-3.0-or-later
"""Disk space that a run needs, and a disk too full for it."""

import shutil
from types import SimpleNamespace

import pytest

from bedchain.case.load import load_case
from bedchain.dem.disk import require_disk, run_bytes
from bedchain.errors import UserError
from made import ROOT


def test_many_layers_take_more_disk():
    case = load_case(ROOT / "cases" / "mueller" / "case.yaml")
    thin = case | {"bed": case["bed"] | {"layers": "one"}}
    columns = 2 * 8 * 9240 * 401  # y and vy of each particle and frame
    assert run_bytes(case) - run_bytes(thin) > columns


def test_the_paper_s_run_needs_gigabytes_and_the_short_one_megabytes(paper):
    frames, number = 801, 81000
    positions = frames * number * (5 * 8 + 4 * 4 + 4)
    once = {"comparison": paper["comparison"] | {"repeats": 0}}
    assert positions < run_bytes(paper | once) < 2 * positions
    assert run_bytes(load_case(ROOT / "cases" / "short" / "case.yaml")) < 500e6


def test_repeats_take_as_much_disk_as_their_windows(paper):
    sizes = [
        run_bytes(paper | {"comparison": paper["comparison"] | {"repeats": number}}) for number in (0, 4)
    ]
    assert 1.9 < sizes[1] / sizes[0] < 2.1  # four windows of 5 s after 20 s


def test_a_full_disk_is_refused_with_space_needed_and_free(tmp_path):
    require_disk(tmp_path, 1)
    with pytest.raises(UserError, match=r"needs 1.00EB on disk, [\d.]+.B are free; free some space"):
        require_disk(tmp_path, 10**18)


def test_little_space_needed_is_given_with_digits(tmp_path, monkeypatch):
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=300))
    with pytest.raises(UserError, match=r"needs 1.20kB on disk, 300B are free"):
        require_disk(tmp_path, 5200, done=4000)
