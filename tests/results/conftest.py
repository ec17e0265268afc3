# SPDX-License-Identifier: GPL-3.0-or-later
"""Artefacts of a case that was run before: ``short``, or the one that BEDCHAIN_CASE names."""

import os
from pathlib import Path

import pandas as pd
import pytest

from bedchain.case import load_case

ROOT = Path(__file__).parents[2]
NAME = os.environ.get("BEDCHAIN_CASE", "short")


@pytest.fixture(scope="session")
def case():
    """The case, with its defaults."""
    return load_case(ROOT / "cases" / NAME / "case.yaml")


@pytest.fixture(scope="session")
def case_folder():
    """Where the case is described."""
    return ROOT / "cases" / NAME


@pytest.fixture(scope="session")
def results():
    """Where the case's artefacts are."""
    return ROOT / "results" / NAME


@pytest.fixture(scope="session")
def metrics(results):
    """Values by source and quantity; where the case was validated, of that too."""
    files = [results / "metrics.csv", *results.glob("validation_metrics.csv")]
    return pd.concat(map(pd.read_csv, files)).set_index(["source", "quantity"]).sort_index()
