# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed packed and unpacked gives the same cells and curves; an archive that does not fit is refused."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest
import yaml

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema
from bedchain.dem.gas_field import gas_near
from bedchain.dem.parameter_files import write_parameters
from bedchain.errors import UserError
from bedchain.measures.mixing import Splits
from bedchain.trajectory.archive import check_archive, read_provenance
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles, open_trajectory, read_manifest
from check_reference import check_reference
from made.gas import COLUMNS, HEIGHT, ROWS, WIDTH, voidage_at, write_gas
from made.synthetic_bed import STAMP, rolling_bed, write_run, write_series
from measure_mixing import measure_mixing
from pack_reference import check_parameters, finished_manifest, pack_reference
from parse_dumps import parse_dumps
from unpack_reference import unpack_reference

NUMBER, CELL, LEVEL = 600, 0.01, 1e-3
TIMES = np.round(np.arange(0, 2 + 1e-9, 0.025), 6)
CASE = {
    "title": "bed of rolls",
    "seed": 10007,
    "bed": {"width_m": WIDTH, "height_m": HEIGHT},
    "particles": {"number": NUMBER},
    "gas": {"cell_size_m": CELL},
    "time": {"end_s": 2.0},
    "learning": {"start_s": 0.5, "end_s": 1.0},
    "comparison": {"start_s": 1.0, "end_s": 2.0, "repeats": 1},
    "cells": {"columns": 8, "rows": 20},
    "mixing": {"split_z_m": 0.06},
    "figures": {"moments_s": [0.5]},
}
START = 10  # first archived frame, 0.25 s before the learning
HALF_PRECISION = 1e-3
OUTPUTS = ("dem.json", "bed_series.csv", "gas.npz", "trajectory.npy", "trajectory.json")


@pytest.fixture(scope="module")
def archived(tmp_path_factory):
    """Folder with a case, its results, and the archive made of them."""
    root = tmp_path_factory.mktemp("archived")
    results = root / "results"
    results.mkdir()
    (root / "case.yaml").write_text(yaml.safe_dump(CASE))
    write_parameters(root / "case.yaml", results)
    frames = rolling_bed(NUMBER, WIDTH, 0.12, TIMES)
    dem = write_run(results, frames, TIMES, WIDTH, HEIGHT)
    write_series(results, np.arange(0, 2, 5e-3), 800.0, 0.06, NUMBER)
    parse_dumps(dem, results / "trajectory.npy", results / "trajectory.json", WIDTH, HEIGHT, progress=False)
    measure_mixing(
        BedFiles(results / "trajectory.npy", results / "trajectory.json"),
        results / "repeats" / "1" / "mixing.csv", "dem_1", Window(1.0, 2.0), Splits(WIDTH / 2, 0.06),
    )  # fmt: skip
    for at, time in ((2, 1.0), (4, 2.0)):
        write_gas(results / "dem" / STAMP / f"segment_{at:04d}" / "gas", cut=at == 4, time_s=time)
    for at in (1, 3):
        shutil.copytree(
            results / "dem" / STAMP / "segment_0002" / "gas",
            results / "dem" / STAMP / f"segment_{at:04d}" / "gas",
        )
    pack_reference(root / "case.yaml", results, root / "reference", LEVEL)
    return root


def unpack(root, target):
    unpack_reference(
        root / "reference" / "provenance.json",
        *(target / name for name in OUTPUTS),
        [target / "repeats" / "1" / "mixing.csv"],
    )


def changed(root, tmp_path, section, **keys):
    """The case with other keys."""
    case = CASE | {section: CASE.get(section, {}) | keys}
    file = tmp_path / "case.yaml"
    file.write_text(yaml.safe_dump(case))
    return load_case(file)


def test_unpacked_bed_is_the_packed_one_to_half_a_level(archived, tmp_path):
    unpack(archived, tmp_path)
    store, described = open_trajectory(tmp_path / "trajectory.npy", tmp_path / "trajectory.json")
    whole, whole_described = open_trajectory(
        archived / "results" / "trajectory.npy", archived / "results" / "trajectory.json"
    )
    assert described["times_s"] == pytest.approx(whole_described["times_s"][START:])
    assert {key: described[key] for key in ("ids", "number", "columns", "units", "width_m", "height_m")} == {
        key: whole_described[key] for key in ("ids", "number", "columns", "units", "width_m", "height_m")
    }
    exact = whole[START:].astype(float)
    assert np.abs(store[:, :2] - exact[:, :2]).max() <= LEVEL / 2 * (1 + 1e-3)
    cells = [np.floor(array[:, :2].astype(float) / CELL) for array in (store, exact)]
    np.testing.assert_array_equal(*cells)
    # of half a level at both ends of two intervals
    central = (exact[2:, :2] - exact[:-2, :2]) / 0.05
    np.testing.assert_allclose(store[1:-1, 2:], central, atol=LEVEL / 0.05 * (1 + 1e-3))


def test_what_else_is_archived_comes_back(archived, tmp_path):
    unpack(archived, tmp_path)
    results = archived / "results"
    assert (tmp_path / "bed_series.csv").read_bytes() == (results / "bed_series.csv").read_bytes()
    one, two = (pd.read_csv(root / "repeats" / "1" / "mixing.csv") for root in (tmp_path, results))
    pd.testing.assert_frame_equal(one.reset_index(drop=True), two)
    manifest, before = read_manifest(tmp_path / "dem.json"), read_manifest(results / "dem.json")
    assert manifest["segments"] == before["segments"]
    assert [frame["step"] for frame in manifest["frames"]] == [
        frame["step"] for frame in before["frames"][START:]
    ]


def test_gas_comes_back_at_the_nearest_moment(archived, tmp_path):
    unpack(archived, tmp_path)
    manifest = read_manifest(tmp_path / "dem.json")
    gas = gas_near(manifest, tmp_path, "voidage", 1.9)
    assert gas.time_s == 2.0
    np.testing.assert_allclose(gas.values, voidage_at(gas.x_m, gas.z_m, 2.0), atol=HALF_PRECISION)
    # the mesh to draw has each value where its cell is
    centres = gas.mesh.cell_centers().points
    np.testing.assert_allclose(
        gas.mesh.cell_data["voidage"], voidage_at(centres[:, 0], centres[:, 2], 2.0), atol=HALF_PRECISION
    )
    assert gas.mesh.n_cells == COLUMNS * ROWS
    assert np.unique(np.load(tmp_path / "gas.npz")["u_z"]).tolist() == [2.0]


def test_a_bed_simulated_again_is_compared_frame_by_frame(archived, tmp_path):
    paths = [archived / "results" / name for name in ("trajectory.npy", "trajectory.json")]
    table = check_reference(archived / "reference", *paths)
    assert len(table) == len(TIMES) - START and (table["same_share_1"] == 1).all()
    np.testing.assert_allclose(table["simulated_height_m"], table["archived_height_m"], atol=LEVEL / 10)
    other = np.load(paths[0])
    other[50:, 1, : NUMBER // 2] += 2 * LEVEL
    np.save(tmp_path / "other.npy", other)
    table = check_reference(archived / "reference", tmp_path / "other.npy", paths[1])
    same = table["same_share_1"].to_numpy()
    assert (same[: 50 - START] == 1).all() and same[50 - START :] == pytest.approx(0.5)
    late = table["simulated_height_m"] - table["archived_height_m"]
    assert late.iloc[-1] == pytest.approx(LEVEL, rel=0.1)


def test_provenance_names_code_case_versions_and_seeds(archived):
    found = read_provenance(archived / "reference")
    assert set(found["git"]) == {"commit", "dirty"}
    assert found["seeds"]["particles"] == 10007 and len(found["seeds"]["repeats"]) == 1
    assert found["packages"]["python"]["numpy"] == np.__version__
    assert len(found["solver_keys_sha256"]) == 64
    assert found["solver_keys"]["gas.cell_size_m"] == CELL


def test_its_own_case_is_served(archived):
    case = load_case(archived / "case.yaml")
    assert check_archive(archived / "reference", case, load_schema())["n_frames"] == len(TIMES) - START


@pytest.mark.parametrize("name", ["positions.xz", "bed_series.csv", "gas.npz", "repeats.csv"])
def test_one_changed_byte_is_found_and_nothing_is_written(archived, tmp_path, name):
    root = tmp_path / "root"
    reference = shutil.copytree(archived / "reference", root / "reference")
    data = bytearray((reference / name).read_bytes())
    data[len(data) // 2] ^= 1
    (reference / name).write_bytes(data)
    with pytest.raises(UserError, match=f"{name} is corrupted.*git checkout"):
        unpack(root, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_half_simulated_bed_is_not_archived(archived, tmp_path):
    results = shutil.copytree(archived / "results", tmp_path / "results")
    manifest = json.loads((results / "dem.json").read_text())
    manifest["frames"] = manifest["frames"][:-8]
    (results / "dem.json").write_text(json.dumps(manifest))
    case = load_case(archived / "case.yaml")
    with pytest.raises(UserError, match="simulated up to 1.8 s of 2 s"):
        finished_manifest(results, case)
    with pytest.raises(UserError, match="reference is there"):
        pack_reference(archived / "case.yaml", results, archived / "reference")
    shutil.rmtree(tmp_path / "results" / "repeats")
    shutil.copy(archived / "results" / "dem.json", results / "dem.json")
    with pytest.raises(UserError, match=r"repeats/1/mixing.csv is missing"):
        finished_manifest(results, case)


def test_a_case_that_was_edited_after_the_simulation_is_not_archived(archived, tmp_path):
    case = changed(archived, tmp_path, "contact", friction_1=0.2)
    with pytest.raises(UserError, match=r"contact.friction_1 is 0.2 and was 0.1; simulate it again"):
        check_parameters(archived / "results", case, load_schema())
    case = changed(archived, tmp_path, "gas", cell_size_m=0.005)
    with pytest.raises(UserError, match=r"bed.width_m / gas.cell_size_m is 16 and was 8"):
        check_parameters(archived / "results", case, load_schema())


def test_a_grid_finer_than_the_levels_leaves_no_archive(archived, tmp_path):
    with pytest.raises(UserError, match="no multiple of 0.003 m"):
        pack_reference(archived / "case.yaml", archived / "results", tmp_path / "reference", 3e-3)
    assert not (tmp_path / "reference").exists()
