# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped cases, each loaded afresh so that a test may change its own."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from made import ROOT


@pytest.fixture
def paper():
    """The paper's case."""
    return load_case(ROOT / "cases" / "paper" / "case.yaml")


@pytest.fixture
def short():
    """The short case."""
    return load_case(ROOT / "cases" / "short" / "case.yaml")


@pytest.fixture
def scene(paper):
    """The scene of the paper's case."""
    return scene_of(paper)
