# SPDX-License-Identifier: GPL-3.0-or-later
"""Artefacts of the cases that were run before: ``short`` and ``paper``, or those that BEDCHAIN_CASE names."""

import os

import pandas as pd
import pytest

from bedchain.case.load import load_case
from made import ROOT

NAMES = os.environ.get("BEDCHAIN_CASE", "short paper").split()


@pytest.fixture(scope="session", params=NAMES)
def case_folder(request):
    """Where the case is described."""
    return ROOT / "cases" / request.param


@pytest.fixture(scope="session")
def case(case_folder):
    """The case, with its defaults."""
    return load_case(case_folder / "case.yaml")


@pytest.fixture(scope="session")
def results(case_folder):
    """Where the case's artefacts are."""
    return ROOT / "results" / case_folder.name


@pytest.fixture(scope="session")
def metrics(results):
    """Values by source and quantity; where the case was validated, of that too."""
    files = [results / "metrics.csv", *results.glob("validation_metrics.csv")]
    return pd.concat(map(pd.read_csv, files)).set_index(["source", "quantity"]).sort_index()
