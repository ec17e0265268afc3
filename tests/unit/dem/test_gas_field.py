# SPDX-License-Identifier: GPL-3.0-or-later
"""Which gas is nearest to a time, and the gas of an archive; reading OpenFOAM's own is in tests/solver."""

import os

import numpy as np
import pytest

from bedchain.dem.gas_field import gas_near, nearest_gas, read_gas_field
from bedchain.errors import UserError

SEGMENTS = [{"end_s": end, "folder": f"dem/segment_{end:g}"} for end in (0.5, 1.0, 1.5)]


def test_the_nearest_segment_that_still_has_the_field_is_taken(tmp_path):
    manifest = {"segments": SEGMENTS}
    for end, name in ((0.5, "voidage"), (1.0, "U"), (1.5, "voidage")):
        folder = tmp_path / f"dem/segment_{end:g}/gas/processor0/{end:g}"
        folder.mkdir(parents=True)
        (folder / name).touch()
    assert nearest_gas(manifest, tmp_path, "voidage", 0.9) == (tmp_path / "dem/segment_0.5/gas", 0.5)
    assert nearest_gas(manifest, tmp_path, "voidage", 1.1)[1] == 1.5
    with pytest.raises(UserError, match="no segment has the gas field p; run run_dem again"):
        nearest_gas(manifest, tmp_path, "p", 1.0)


def test_archived_gas_has_each_value_where_its_cell_is(tmp_path):
    z, x = np.meshgrid((np.arange(3) + 0.5) * 0.02, (np.arange(2) + 0.5) * 0.01, indexing="ij")
    times, x, z = np.array([0.5, 1.0]), x.ravel(), z.ravel()
    values = np.add.outer(times, 10 * x + z).astype(np.float16)
    np.savez(tmp_path / "gas.npz", times_s=times, x_m=x, z_m=z, voidage=values)
    gas = gas_near({"gas": "gas.npz"}, tmp_path, "voidage", 0.8)
    assert gas.time_s == 1.0 and gas.values == pytest.approx(values[1].astype(float))
    centres = gas.mesh.cell_centers().points
    assert centres[:, 0] == pytest.approx(x) and centres[:, 2] == pytest.approx(z)
    assert gas.mesh.cell_data["voidage"] == pytest.approx(1.0 + 10 * centres[:, 0] + centres[:, 2], abs=1e-3)


def test_gas_outside_the_run_and_pipes_in_it_are_refused(tmp_path):
    for name in ("/tmp/gas.npz", "../gas.npz"):
        with pytest.raises(UserError, match="is not within this folder"):
            gas_near({"gas": name}, tmp_path, "voidage", 1.0)
    with pytest.raises(UserError, match="is not within this folder"):
        nearest_gas({"segments": [{"end_s": 1.0, "folder": "../dem"}]}, tmp_path, "voidage", 1.0)
    (tmp_path / "0.5").mkdir()
    os.mkfifo(tmp_path / "0.5" / "voidage")
    with pytest.raises(UserError, match="voidage is a special file"):
        read_gas_field(tmp_path, "voidage")
