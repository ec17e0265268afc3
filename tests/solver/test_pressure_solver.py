# SPDX-License-Identifier: GPL-3.0-or-later
"""The band that solves the pressure: against multigrid, and where multigrid takes over."""

import shutil
from pathlib import Path

import pandas as pd

from bedchain.dem import small_cases
from bedchain.dem.lattices import lattice
from bedchain.dem.small_cases import Setup, run_gas

ROOT = Path(__file__).parents[2]
MULTIGRID = "{ solver GAMG; smoother DIC; nCellsInCoarsestLevel 10; tolerance 1e-13; relTol 0; }"
DIAMETER, CELL = 1e-3, 5e-3
STEPS_S = 0.01


def held_particles(folder, width_m):
    """A lattice of particles, held in place in the left of a bed."""
    sections = {
        "bed": {"width_m": width_m, "height_m": 0.04},
        "particles": {"number": 1},  # the deck gets the true number below
        "gas": {"cell_size_m": CELL},
        "time": {"frame_interval_s": STEPS_S},
    }
    spheres = lattice(0.02, 0.02, 1.5 * DIAMETER, DIAMETER)
    return Setup(folder, sections, spheres, {"frozen": 1, "number": len(spheres)})


def solved_by(folder):
    """Names of the solvers of the pressure in a run's log."""
    lines = (folder / "bedFoam.log").read_text(encoding="utf-8").splitlines()
    return {line.split(":")[0] for line in lines if "Solving for p" in line}


def test_band_and_multigrid_give_the_same_gas(solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    bed = held_particles(tmp_path / "band", 0.04)
    by_band = run_gas(bed, solver, STEPS_S, "constant 0.5", tight=True)
    assert solved_by(bed.folder) == {"bandPCG"}

    case = tmp_path / "openfoam_case"
    shutil.copytree(ROOT / "openfoam_case", case)
    with (case / "system" / "fvSolution").open("a", encoding="utf-8") as stream:
        stream.write(f"solvers {{ pBand {MULTIGRID} pBandFinal {MULTIGRID} }}\n")
    monkeypatch.setattr(small_cases, "GAS_CASE", case)
    bed = held_particles(tmp_path / "multigrid", 0.04)
    by_multigrid = run_gas(bed, solver, STEPS_S, "constant 0.5", tight=True)
    assert solved_by(bed.folder) == {"GAMG"}
    columns = ["pressure_drop_Pa", "weight_on_gas_1"]
    pd.testing.assert_frame_equal(by_band[columns], by_multigrid[columns], rtol=1e-8)


def test_multigrid_solves_a_bed_too_wide_for_its_band(solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    bed = held_particles(tmp_path / "wide", 101 * CELL)
    table = run_gas(bed, solver, STEPS_S, "constant 0.5")
    assert solved_by(bed.folder) == {"GAMG"}
    assert (table["volume_balance_1"] < 1e-5).all()
