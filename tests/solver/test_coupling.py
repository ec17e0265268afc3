# SPDX-License-Identifier: GPL-3.0-or-later
"""bedFoam's exchange between gas and particles: conservation, and the same on one rank and on several."""

import json
import re
import shutil

import numpy as np
import pandas as pd
import pytest

from bedchain.dem import gas_case
from bedchain.dem.run import input_files, run_dem
from bedchain.dem.segments import input_stamp
from bedchain.errors import UserError
from bedchain.trajectory.dumps import read_dump

ROUND_OFF = 1e-12  # relative, of sums over some hundred terms
SOLVER_TOLERANCE = 1e-5  # of the pressure solve, between runs that cut the mesh differently
VOLUME_BALANCE = 1e-5  # of a cell's volume a step, by the pressure solve's tolerance
WEIGHT = 0.03  # of the weight per area


def series(folder):
    return pd.read_csv(folder / "bed_series.csv")


def positions(folder, step):
    """Particles by id at a step: (number, 5) id, x, z, vx, vz."""
    listed = json.loads((folder / "dem.json").read_text())
    file = next(frame["file"] for frame in listed["frames"] if frame["step"] == step)
    values = read_dump(folder / file, listed["columns"]).values
    return values[np.argsort(values[:, 0])]


def test_what_the_particles_get_the_gas_loses(make_bed):
    folder = make_bed("bed")
    run_dem(folder, 0.06, 0.02, 2)
    table = series(folder)
    assert table["exchange_error_1"].max() < ROUND_OFF
    assert table["volume_balance_1"].max() < VOLUME_BALANCE
    assert (table["particles_1"] == 300).all()
    assert table["voidage_clips_1"].sum() == 0


@pytest.mark.parametrize("ranks", [2, 3, 4, 6])
def test_ranks_agree_on_the_first_steps(make_bed, ranks):
    # six gas cells along the width, or four
    wide = {"bed": {"width_m": 0.03}, "particles": {"number": 450}} if ranks % 3 == 0 else {}
    alone, together = make_bed("alone", **wide), make_bed("together", **wide)
    run_dem(alone, 0.008, 0.008, 1)
    # Both begin with the bed that settled on one rank
    settled = next(alone.glob("dem/*/settled"))
    shutil.copytree(settled, together / "dem" / input_stamp(input_files(together)) / "settled")
    run_dem(together, 0.008, 0.008, ranks)
    one, several = series(alone), series(together)
    np.testing.assert_allclose(
        several["pressure_drop_Pa"][0], one["pressure_drop_Pa"][0], rtol=SOLVER_TOLERANCE
    )
    np.testing.assert_allclose(several["mean_height_m"], one["mean_height_m"], rtol=SOLVER_TOLERANCE)


def test_a_bed_begun_on_two_ranks_ends_on_three(make_bed):
    folder = make_bed("bed", bed={"width_m": 0.03}, particles={"number": 450})
    run_dem(folder, 0.02, 0.02, 2)
    begun = series(folder)
    run_dem(folder, 0.04, 0.02, 3)
    table = series(folder)
    assert len(list(folder.glob("dem/*/settled"))) == 1, "other ranks began anew"
    assert len(list(folder.glob("dem/*/segment_0002/gas/processor*"))) == 3
    assert table.iloc[: len(begun)].equals(begun)
    assert table["exchange_error_1"].max() < ROUND_OFF
    assert table["volume_balance_1"].max() < VOLUME_BALANCE
    assert (table["particles_1"] == 450).all()
    # the gas goes on with its last field: no jump of its pressure over the seam
    drop, seam = table["pressure_drop_Pa"].to_numpy(), len(begun)
    assert abs(drop[seam] - drop[seam - 1]) < 3 * np.abs(np.diff(drop[seam - 2 : seam])).max() + 1


def test_ranks_give_the_same_statistics_later(make_bed):
    # The paths of two runs part within tenths of a second; what they do on average does not
    blocks = {}
    for ranks in (1, 2):
        folder = make_bed(f"on_{ranks}", bed={"height_m": 0.2}, time={"end_s": 2.0, "segment_s": 1.0})
        run_dem(folder, 2.0, 1.0, ranks)
        table = series(folder)
        bubbling = table[table["time_s"] > 0.4]
        block = (bubbling["time_s"] // 0.2).astype(int)
        blocks[ranks] = bubbling.groupby(block)[["pressure_drop_Pa", "mean_height_m"]].mean()
    one, two = blocks[1], blocks[2]
    assert len(one) == len(two) >= 8
    assert not np.allclose(one, two, rtol=1e-6)
    error = np.sqrt((one.var() + two.var()) / len(one))
    assert ((one.mean() - two.mean()).abs() < 4 * error).all()
    # The blocks tell something: the errors are small against the means
    assert (error < 0.1 * one.mean()).all()


def test_a_bed_at_rest_below_fluidization_stays(make_bed):
    # After 0.15 s one particle in some of these beds still falls
    folder = make_bed("bed", gas={"superficial_velocity_m_s": 0.1}, time={"settle_s": 0.3})
    run_dem(folder, 0.02, 0.02, 1)
    moved = positions(folder, 1000)[:, 1:3] - positions(folder, 0)[:, 1:3]
    assert np.abs(moved).max() < 1e-4


def test_slabs_that_do_not_fit_are_refused(make_bed):
    folder = make_bed("bed")
    with pytest.raises(
        UserError, match=r"4 gas cells along x cannot be cut into 3 equal slabs.*gas.cell_size_m"
    ):
        run_dem(folder, 0.004, 0.004, 3)


def test_a_mesh_without_the_inlet_is_refused(make_bed, tmp_path, monkeypatch):
    case = tmp_path / "openfoam_case"
    shutil.copytree(gas_case.GAS_CASE, case)
    for name in ("system/blockMeshDict", "0.orig/U", "0.orig/p"):
        text, found = re.subn(r"\binlet$|\binlet(?= +\{)", "floor", (case / name).read_text(), flags=re.M)
        assert found == 1
        (case / name).write_text(text)
    monkeypatch.setattr(gas_case, "GAS_CASE", case)
    folder = make_bed("bed")
    with pytest.raises(UserError, match=r"has no patch inlet, only .*floor.*system/blockMeshDict"):
        run_dem(folder, 0.004, 0.004, 1)


def test_an_unknown_drag_law_names_those_that_exist(make_bed):
    folder = make_bed("bed")
    file = folder / "caseParameters"
    file.write_text(re.sub(r"drag_law \w+", "drag_law nobody", file.read_text()))
    with pytest.raises(UserError, match='drag law "nobody" does not exist; there are "gidaspow"'):
        run_dem(folder, 0.004, 0.004, 1)
