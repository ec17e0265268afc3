# SPDX-License-Identifier: GPL-3.0-or-later
"""A good case as text, with one text replaced by another, and how a mistake in it must be refused."""

from pathlib import Path

import pytest

from bedchain.case.load import load_case
from bedchain.errors import CaseError

CASE = """\
title: a small bed
seed: 15485863
bed:
  width_m: 0.09
  height_m: 0.45
particles:
  number: 7200
time:
  end_s: 5.0  # simulated
learning:
  start_s: 1.0
  end_s: 3.0
comparison:
  start_s: 3.0
  end_s: 5.0
cells:
  columns: 10
  rows: 50
mixing:
  split_z_m: 0.081
figures:
  batch_height_m: 0.027
"""
END = "  end_s: 5.0  # simulated"


def changed_case(folder: Path, *replacements: tuple[str, str]) -> Path:
    """File of the case with texts replaced; each must be there exactly once."""
    text = CASE
    for old, new in replacements:
        assert text.count(old) == 1, f"{old!r} is {text.count(old)} times in CASE"
        text = text.replace(old, new)
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def assert_refused(file: Path, key: str, message: str) -> None:
    """Loading gives a problem with the key, in its line, with these words."""
    with pytest.raises(CaseError) as caught:
        load_case(file)
    problems = [problem for problem in caught.value.problems if problem.key == key]
    assert problems, f"no problem with {key} in: {caught.value}"
    assert str(file) in str(caught.value)
    assert message in f"{problems[0].wrong}; {problems[0].remedy}"
    lines = file.read_text(encoding="utf-8").splitlines()
    if problems[0].line is not None and "missing" not in problems[0].wrong:
        assert key.split(".")[-1].split("[")[0] in lines[problems[0].line - 1]
