# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage of gas cells finer than the smoothing: nothing lost at walls or between ranks, walls unseen."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from bedchain.dem.gas_case import last_time
from bedchain.dem.lattices import lattice
from bedchain.dem.run import input_files, run_dem, settle
from bedchain.dem.segments import SETTLED, SegmentedRun, input_stamp
from bedchain.dem.small_cases import Setup, run_gas
from made import ROOT

LENGTHS = [0, 2, 3, 4]  # diameters
DIAMETER, WIDTH, HEIGHT = 1e-3, 0.02, 0.06
NUMBER = 300
STEP = 2e-4  # [s] of the gas, short enough for cells of a diameter
ROUND_OFF = 1e-12  # relative, of the sum over some thousand cells
PATTERN = 1e-12  # of the voidage, by round-off
BETWEEN_RANKS = 1e-12  # of the voidage: the ranks add up the same shares in another order
SPHERE = np.pi / 6 * DIAMETER**3


@pytest.fixture(scope="module")
def settled_once(tmp_path_factory):
    """Folder that keeps the settled bed for all lengths."""
    return tmp_path_factory.mktemp("settled")


def voidage_rows(case, cell):
    """Voidage as (n_rows, n_columns), from the bottom up and from left to right, in full precision."""
    slabs = []
    for part in sorted(case.glob("processor*")) or [case]:
        content = (last_time(part) / "voidage").read_bytes()
        found = re.search(rb"nonuniform List<scalar>\s*(\d+)\s*\(", content)
        values = np.frombuffer(content, count=int(found[1]), offset=found.end())
        slabs.append(values.reshape(round(HEIGHT / cell), -1))
    return np.hstack(slabs)


def solids_of(voidage):
    """Volume of all particles that the cells hold [m3]; the slab is one diameter thick."""
    cell = WIDTH / voidage.shape[1] * HEIGHT / voidage.shape[0] * DIAMETER
    return (1 - voidage).sum() * cell


def after_one_exchange(make_bed, settled_once, length, cell, ranks):
    """Voidage of the settled bed after one step of a gas at rest."""
    folder = make_bed(
        f"bed_{ranks}",
        gas={"cell_size_m": cell, "smoothing_diameters_1": length, "superficial_velocity_m_s": 0.0},
        run={"ranks": ranks},
        time={"gas_step_s": STEP, "frame_interval_s": STEP, "segment_s": STEP},
    )
    run = SegmentedRun(folder, folder, input_stamp(input_files(folder)), ranks, 0, 1, SETTLED)
    if not (settled_once / SETTLED).exists():
        settle(replace(run, ranks=1))
        shutil.copytree(run.state / SETTLED, settled_once / SETTLED)
    elif not (run.state / SETTLED).exists():
        shutil.copytree(settled_once / SETTLED, run.state / SETTLED)
    run_dem(folder, STEP, STEP, ranks)
    table = pd.read_csv(folder / "bed_series.csv")
    assert (table["voidage_clips_1"] == 0).all()
    return voidage_rows(run.state / "segment_0001" / "gas", cell)


@pytest.mark.parametrize("length", LENGTHS)
def test_no_solid_is_lost_at_walls_or_between_ranks(make_bed, settled_once, length):
    alone, together = (after_one_exchange(make_bed, settled_once, length, 1e-3, ranks) for ranks in (1, 2))
    assert alone.shape == (60, 20)
    for voidage in (alone, together):
        assert solids_of(voidage) == pytest.approx(NUMBER * SPHERE, rel=ROUND_OFF)
    np.testing.assert_allclose(together, alone, atol=BETWEEN_RANKS)


def held(folder, solver, length, cell, spheres):
    """Voidage around spheres that are held in place, after one step of a gas at rest."""
    sections = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"number": 1},
        "gas": {"cell_size_m": cell, "smoothing_diameters_1": length},
        "time": {"gas_step_s": STEP, "frame_interval_s": STEP},
    }
    setup = Setup(folder, sections, spheres, {"frozen": 1, "number": len(spheres)})
    run_gas(setup, solver, STEP, "constant 0")
    return voidage_rows(folder / "gas", cell)


def largest_ripple(length, cell, spacing):
    """Most that a square lattice may ripple the solids [1].

    The two lowest harmonics in either direction, under the hat function of a cell and a Gaussian of the
    variance that the length adds, at the wavelengths that the cells see.
    """
    added = max((length * DIAMETER) ** 2 / 12 - cell**2 / 6, 0)
    harmonics = np.array([1, 2]) / spacing
    seen = np.abs(harmonics - np.round(harmonics * cell) / cell)
    along = 2 * np.sinc(harmonics * cell) ** 2 * np.exp(-((2 * np.pi * seen) ** 2) * added / 2)
    return (1 + along.sum()) ** 2 - 1


@pytest.mark.parametrize("length", LENGTHS)
def test_a_uniform_packing_is_as_uniform_at_the_walls_as_inside(solver, tmp_path, monkeypatch, length):
    # Four spheres on five cells: the pattern of lattice and cells repeats each 5 mm, up to the walls
    monkeypatch.chdir(ROOT)
    spacing, period = 1.25 * DIAMETER, 5
    voidage = held(tmp_path / "bed", solver, length, DIAMETER, lattice(WIDTH, HEIGHT, spacing, DIAMETER))
    inside = voidage[4 * period : 5 * period, period : 2 * period]
    rows, columns = np.array(voidage.shape) // period
    np.testing.assert_allclose(voidage, np.tile(inside, (rows, columns)), atol=PATTERN)
    mean = 1 - SPHERE / (spacing**2 * DIAMETER)
    assert voidage.mean() == pytest.approx(mean, rel=ROUND_OFF)
    assert np.abs(voidage - mean).max() < (1 - mean) * largest_ripple(length, DIAMETER, spacing)


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("cell", [1e-3, 2e-3])
def test_a_particle_is_spread_with_the_variance_of_the_length(solver, tmp_path, monkeypatch, length, cell):
    monkeypatch.chdir(ROOT)
    x, z = 9.3e-3, 30.6e-3
    sphere = np.array([[x, z, 0, 0, DIAMETER]])
    solids = 1 - held(tmp_path / "bed", solver, length, cell, sphere)
    share = solids / solids.sum()
    widened = max((length * DIAMETER) ** 2 / 12 - cell**2 / 6, 0)
    for axis, place in ((1, x), (0, z)):
        centres = (np.arange(solids.shape[axis]) + 0.5) * cell
        weights = share.sum(axis=1 - axis)
        part = (place / cell - 0.5) % 1
        assert (weights * centres).sum() == pytest.approx(place, rel=1e-9)
        variance = (weights * (centres - place) ** 2).sum()
        assert variance == pytest.approx(part * (1 - part) * cell**2 + widened, rel=1e-6)
