# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a simulated bed in the trade-off study: all are cases, and what fails is a row."""

import sys
from pathlib import Path

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.case.variants import Variant
from bedchain.errors import UserError
from bedchain.studies.tradeoff import simulated_beds
from bedchain.studies.tradeoff.bed_variants import BedVariant, bed_variants
from bedchain.studies.tradeoff.observables import BedObservables
from bedchain.studies.tradeoff.simulated_beds import measure_all, simulate_bed, solver_memory
from made.realisations import realisations

SHORT = Path("cases/short/case.yaml")


@pytest.fixture(autouse=True)
def in_repository(monkeypatch, request):
    """Case files are named from the repository."""
    monkeypatch.chdir(request.config.rootpath)


def test_a_realisation_is_not_compared_with_itself(monkeypatch, tmp_path):
    reference = realisations(number=3)
    known = {"base": 0.05, "seed_1": 0.07, "friction_0": 0.08}

    def bed_row(one, folder):
        name = one.variant.name
        bed = BedObservables(reference.curves[0], reference.densities[0], {"bed_height": known[name]})
        return {"variant": name, "cost_s": 1.0, "problem": ""}, bed

    monkeypatch.setattr(simulated_beds, "bed_row", bed_row)
    variants = bed_variants(load_case(SHORT))
    rows = measure_all([variants[name] for name in known], tmp_path, reference)
    own = list(reference.scalars["bed_height"])
    for row, pool in zip(rows, ([0.07], [0.05], [0.05, 0.07]), strict=True):
        error = known[row["variant"]] - np.mean(own + pool)
        assert row["bed_height_error_m"] == pytest.approx(error)
        assert row["bed_height_floors_1"] == pytest.approx(error / np.std(own + pool, ddof=1))


def test_a_variant_that_cannot_run_is_a_row_with_its_reason(tmp_path):
    wrong = [
        BedVariant("ablation", Variant("long_step", {"time.dem_step_s": 2.5e-4})),
        BedVariant("ablation", Variant("no_bed", {"bed.width_m": -1.0})),
    ]
    for bed in wrong:
        simulate_bed(SHORT, bed, tmp_path / bed.variant.name)
    rows = measure_all(wrong, tmp_path, realisations())
    assert [row["variant"] for row in rows] == ["long_step", "no_bed"]
    assert "Rayleigh" in rows[0]["problem"] and "bed.width_m" in rows[1]["problem"]
    assert rows[0]["changed"] == "time.dem_step_s 0.00025"
    assert not {"cost_s", "mixing_error_1"} & set(rows[0])


def test_a_variant_that_nobody_simulated_is_named_with_the_way_to_it(tmp_path):
    with pytest.raises(UserError, match=r"base is not simulated: scripts/run_variant.py"):
        measure_all([bed_variants(load_case(SHORT))["base"]], tmp_path, realisations())


def test_memory_is_that_of_solvers_with_the_folder_in_their_command():
    # this very process runs, but is no solver
    assert solver_memory(sys.argv[0]) == 0.0
