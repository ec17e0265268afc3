# SPDX-License-Identifier: GPL-3.0-or-later
"""The band that solves the pressure: against numpy and against multigrid, and where multigrid takes over."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from bedchain.dem import small_cases
from bedchain.dem.lattices import lattice
from bedchain.dem.small_cases import Setup, run_gas

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SOURCES = ROOT / "openfoam_case/solver/bedFoam"
ROUND_OFF = 1e-10  # the matrices' conditions are below 1e4
MULTIGRID = "{ solver GAMG; smoother DIC; nCellsInCoarsestLevel 10; }"
DIAMETER, CELL = 1e-3, 5e-3
STEPS_S = 0.01


@pytest.fixture(scope="module")
def band_factor(tmp_path_factory):
    """Function that solves a symmetric matrix of a band's width by the solver's own code."""
    program = tmp_path_factory.mktemp("band") / "band_factor"
    sources = [str(HERE / "band_factor.C"), str(SOURCES / "BandFactor.C")]
    checks = ["-fsanitize=address,undefined", "-D_GLIBCXX_ASSERTIONS"]
    subprocess.run(["g++", "-std=c++14", "-O2", *checks, f"-I{SOURCES}", *sources, "-o", program], check=True)

    def solve(matrix, width, right):
        padded = np.pad(matrix, (0, width))
        columns = [padded[column : column + width + 1, column] for column in range(len(matrix))]
        numbers = [len(matrix), width, *np.ravel(columns), *right]
        text = " ".join(
            repr(float(number)) if index > 1 else str(number) for index, number in enumerate(numbers)
        )
        done = subprocess.run([program], input=text, capture_output=True, text=True, check=True)
        return np.array(done.stdout.split(), dtype=float)

    return solve


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("size", "width"), [(1, 0), (3, 1), (8, 3), (17, 4), (30, 7), (41, 20), (5, 9)])
def test_a_band_is_solved_to_round_off(band_factor, size, width, sign):
    rng = np.random.default_rng(size * 100 + width)
    lower = np.tril(np.triu(rng.normal(size=(size, size)), -width))
    matrix = sign * (lower @ lower.T + np.eye(size))
    right = rng.normal(size=size)
    assert band_factor(matrix, width, right) == pytest.approx(
        np.linalg.solve(matrix, right), rel=ROUND_OFF, abs=ROUND_OFF
    )


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
        stream.write(f"solvers {{ p {MULTIGRID} pFinal {MULTIGRID} }}\n")
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
