# SPDX-License-Identifier: GPL-3.0-or-later
"""The networks of cases/: their expected numbers, checks, figures; and pages that cannot be."""

from pathlib import Path

import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.comparison.expected import deviations, read_expected
from made import ROOT
from made.drawings import DPI, OnlyChecked
from plot_network_axial import plot_network_axial
from plot_network_conversion import plot_network_conversion
from plot_network_mixtures import plot_network_mixtures
from plot_network_path import plot_network_path
from plot_network_pulses import plot_network_pulses
from plot_network_residence import plot_network_residence
from plot_network_states import plot_network_states
from run_network import COLUMNS, Tables, run_network

NETWORKS = sorted(
    file.parent.name for file in (ROOT / "cases").glob("*/case.yaml") if "\nnetwork:" in file.read_text()
)
PLOTS = {
    "states": plot_network_states,
    "residence": plot_network_residence,
    "path": plot_network_path,
    "pulses": plot_network_pulses,
    "mixtures": plot_network_mixtures,
    "axial": plot_network_axial,
    "conversion": plot_network_conversion,
}
# contents over throughput and the mean of the matrix are the same sum in another order
ROUND_OFF = 1e-12
# the largest of some thousand normal numbers is about 4
SIGMAS = 6


def run(case, folder, place="cases/made/case.yaml"):
    """Numbers of a page, with its tables in a folder."""
    tables = Tables(**{name: folder / f"{name}.csv" for name in COLUMNS})
    run_network(case["network"], place, folder / "metrics.csv", tables)
    return pd.read_csv(folder / "metrics.csv")


@pytest.fixture(scope="module", params=NETWORKS)
def scene(request, tmp_path_factory):
    """Name, folder of results, and numbers of a network of cases/."""
    folder = tmp_path_factory.mktemp(request.param)
    file = ROOT / "cases" / request.param / "case.yaml"
    return request.param, folder, run(load_case(file), folder, str(file))


def test_numbers_are_as_expected(scene):
    name, _, metrics = scene
    expected = read_expected(ROOT / "cases" / name / "expected.csv")
    assert len(expected) and deviations(expected, metrics) == []


def test_every_check_holds(scene):
    numbers = scene[2].set_index(["quantity", "source"])["value"]
    for quantity in ("row_sum_error", "hold_up_error", "danckwerts_error"):
        if quantity in numbers.index.get_level_values(0):
            assert numbers[quantity].max() <= ROUND_OFF, quantity
    assert numbers["monte_carlo_sigmas"].between(0.5, SIGMAS).all()


def test_figures_show_every_chain(scene):
    _, folder, _ = scene
    for table, plot in PLOTS.items():
        if len(numbers := pd.read_csv(folder / f"{table}.csv")) and (
            "height_m" not in numbers or numbers["height_m"].notna().any() or table == "states"
        ):
            files = OnlyChecked(
                *(Path(folder / f"fig_{table}.{form}") for form in ("png", "pdf", "csv")), DPI
            )
            plot(folder / f"{table}.csv", files)
            assert (folder / f"fig_{table}.csv").exists()
