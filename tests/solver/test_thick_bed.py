# SPDX-License-Identifier: GPL-3.0-or-later
"""Beds several particles thick: free between walls in front and behind, gas in three dimensions or two."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from bedchain.dem.run import input_files, run_dem
from bedchain.dem.segments import input_stamp, read_parameters
from bedchain.errors import CaseError
from bedchain.trajectory.dumps import read_dump

THICK = {
    "bed": {"width_m": 0.02, "height_m": 0.06, "thickness_m": 0.005, "layers": "many"},
    "particles": {"number": 1500},
    "gas": {"cell_size_m": 2.5e-3},
}
DIAMETER = 1e-3
ROUND_OFF = 1e-12  # relative, of sums over some thousand terms
# between runs that cut the mesh differently: one rank solves the pressure to round-off, several to less
SOLVER_TOLERANCE = 3e-5
VOLUME_BALANCE = 1e-5  # of a cell's volume a step, by the pressure solve's tolerance
WEIGHT = 0.01  # of the bed's: what still moves after the fall
MOVING = 1e-3  # [m/s], a tenth of what the particles of a plug have across
OVERLAP = 0.05  # of the diameter, with walls as soft as the particles


def thick(make_bed, name, **changes):
    """A bed five diameters thick, with changes by section."""
    return make_bed(name, **{key: THICK.get(key, {}) | changes.get(key, {}) for key in {*THICK, *changes}})


def frames(folder):
    """All frames by column name, particles by id: each (n_frames, number)."""
    listed = json.loads((folder / "dem.json").read_text())
    values = [read_dump(folder / frame["file"], listed["columns"]).values for frame in listed["frames"]]
    sorted_values = np.stack([table[np.argsort(table[:, 0])] for table in values])
    return {name: sorted_values[..., column] for column, name in enumerate(listed["columns"])}


@pytest.mark.parametrize(("depth", "cells"), [(0.005, 2), (0.003, 1)])
def test_a_fluidized_bed_keeps_particles_and_momentum_between_its_walls(make_bed, depth, cells):
    folder = thick(make_bed, "bed", bed={"thickness_m": depth}, particles={"number": round(300e3 * depth)})
    assert read_parameters(folder / "parameters.lig")["gas_cells_y"] == cells
    run_dem(folder, 0.06, 0.02, 1)
    table, found = pd.read_csv(folder / "bed_series.csv"), frames(folder)
    assert (table["particles_1"] == round(300e3 * depth)).all()
    assert table["exchange_error_1"].max() < ROUND_OFF
    assert table["volume_balance_1"].max() < VOLUME_BALANCE
    assert table["voidage_clips_1"].sum() == 0
    # all of the depth is used, and nothing is behind the walls
    reach = depth / 2 - DIAMETER / 2
    assert np.abs(found["y"]).max() < reach + OVERLAP * DIAMETER
    assert np.abs(found["y"]).max(axis=1).min() > reach - OVERLAP * DIAMETER
    assert np.histogram(found["y"][-1], 3, (-depth / 2, depth / 2))[0].min() > 0
    assert found["vy"][-1].std() > MOVING


def test_gas_floor_and_walls_carry_a_bed_at_rest(make_bed):
    folder = thick(make_bed, "bed", gas={"superficial_velocity_m_s": 0.2}, time={"settle_s": 0.3})
    run_dem(folder, 0.04, 0.04, 1)
    last = pd.read_csv(folder / "bed_series.csv").iloc[-1]
    parts = last[["weight_on_gas_1", "weight_on_floor_1", "weight_on_sides_1"]]
    assert parts.sum() == pytest.approx(1, abs=WEIGHT)
    assert parts["weight_on_gas_1"] > 0.1


def test_two_ranks_agree_with_one_on_the_first_steps(make_bed):
    alone, together = thick(make_bed, "alone"), thick(make_bed, "together")
    run_dem(alone, 0.008, 0.008, 1)
    settled = next(alone.glob("dem/*/settled"))
    shutil.copytree(settled, together / "dem" / input_stamp(input_files(together)) / "settled")
    run_dem(together, 0.008, 0.008, 2)
    one, two = (pd.read_csv(folder / "bed_series.csv") for folder in (alone, together))
    for name in ("pressure_drop_Pa", "mean_height_m", "smallest_voidage_1"):
        assert two[name][0] == pytest.approx(one[name][0], rel=SOLVER_TOLERANCE), name


@pytest.mark.parametrize(
    ("bed", "number", "said"),
    [
        ({"thickness_m": 0.0009}, 100, "narrower than a particle"),
        ({"thickness_m": 0.0011}, 100, "narrower than the lattice"),
        ({"height_m": 0.02}, 1500, "raise bed.height_m"),
    ],
)
def test_a_bed_that_cannot_hold_its_particles_is_refused(make_bed, bed, number, said):
    with pytest.raises(CaseError, match=said):
        thick(make_bed, "bed", bed=bed, particles={"number": number})
