# SPDX-License-Identifier: GPL-3.0-or-later
"""From the frames of a thick bed to its table, metrics and figure against known profiles."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import DataError, UserError
from bedchain.figures.style import FigureFiles
from bedchain.measures.voidage import Slab
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from made.synthetic_bed import STAMP, write_binary_dump
from parse_dumps import parse_dumps
from validate_bed import Published, validate_bed

WIDTH, HEIGHT, DEPTH, RADIUS, NUMBER = 0.044, 0.05, 0.01, 6e-4, 6000
FILLED = 0.04
TIMES = np.arange(0, 1.01, 0.025)
VOIDAGE = 1 - NUMBER * 4 / 3 * np.pi * RADIUS**3 / (WIDTH * FILLED * DEPTH)
SPEED = 0.2
POSITIONS = np.linspace(0.004, 0.04, 10)
# scatter of as many frames of particles put down at random, several times over
VOIDAGE_ERROR, VELOCITY_ERROR = 0.01, 0.01


def speed_at(x):
    """Upwards in the middle, downwards at the walls [m/s]."""
    return -SPEED * np.cos(2 * np.pi * x / WIDTH)


@pytest.fixture(scope="module")
def bed(tmp_path_factory):
    """Folder with frames in the columns of a thick bed, made into a trajectory."""
    folder, rng = tmp_path_factory.mktemp("thick"), np.random.default_rng(4)
    frames = []
    for time in TIMES:
        x, y, z = (rng.uniform(0, size, NUMBER) for size in (WIDTH, DEPTH, FILLED))
        still = np.zeros(NUMBER)
        table = np.column_stack([np.arange(1, NUMBER + 1), x, y - DEPTH / 2, z, still, still, speed_at(x)])
        file = f"dem/{STAMP}/segment_0001/frame_{round(time / 2e-5)}.bin"
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        box = [(0, WIDTH), (-DEPTH, DEPTH), (0, HEIGHT)]
        write_binary_dump(folder / file, round(time / 2e-5), rng.permutation(table), box)
        frames.append({"step": round(time / 2e-5), "time_s": float(time), "file": file})
    manifest = {
        "frame_interval_s": 0.025, "number": NUMBER, "frames": frames,
        "columns": ["id", "x", "y", "z", "vx", "vy", "vz"],
    }  # fmt: skip
    (folder / "dem.json").write_text(json.dumps(manifest))
    names = folder / "trajectory.npy", folder / "trajectory.json"
    parse_dumps(folder / "dem.json", *names, WIDTH, HEIGHT, progress=False)
    return folder


@pytest.fixture
def validated(bed, tmp_path):
    """Function that validates a window against points and returns the folder of the results."""

    def run(points, start_s=0.0, end_s=1.0, peers=()):
        file = tmp_path / "measured.csv"
        points.to_csv(file, index=False)
        files = FigureFiles(tmp_path / "v.png", tmp_path / "v.pdf", tmp_path / "v.csv", 60)
        validate_bed(
            BedFiles(bed / "trajectory.npy", bed / "trajectory.json"), Published(file, list(peers)),
            tmp_path / "table.csv", tmp_path / "metrics.csv", files, Window(start_s, end_s),
            WIDTH, Slab(DEPTH, 2 * RADIUS),
        )  # fmt: skip
        return tmp_path

    return run


def known_points():
    """What the bed should show at two heights."""
    both = {"voidage_1": np.full(len(POSITIONS), VOIDAGE), "particle_velocity_m_s": speed_at(POSITIONS)}
    return pd.concat(
        pd.DataFrame({"quantity": name, "height_m": height, "position_x_m": POSITIONS, "value": values})
        for name, values in both.items()
        for height in (0.015, 0.025)
    )


def test_a_bed_of_known_profiles_is_found_to_have_them(validated):
    folder = validated(known_points())
    metrics = pd.read_csv(folder / "metrics.csv").set_index("quantity")
    assert metrics.loc["voidage_error_rms", "value"] < VOIDAGE_ERROR
    assert metrics.loc["particle_velocity_error_rms", "value"] < VELOCITY_ERROR
    assert metrics["aim"].dropna().to_dict() == {
        "voidage_error_rms": 0.05,
        "particle_velocity_error_rms": 0.04,
    }
    table = pd.read_csv(folder / "table.csv")
    assert list(table) == [
        "quantity", "height_m", "position_x_m", "measured", "simulated", "ci_low", "ci_high",
    ]  # fmt: skip
    assert len(table) == len(known_points())
    assert (table["ci_low"] <= table["simulated"]).all() and (table["simulated"] <= table["ci_high"]).all()
    for name in ("v.png", "v.pdf", "v.csv"):
        assert (folder / name).stat().st_size > 0


def test_simulated_profiles_are_averaged_with_their_mirror_images(validated):
    table = pd.read_csv(validated(known_points()) / "table.csv")
    for _, profile in table.groupby(["quantity", "height_m"]):
        values = profile.sort_values("position_x_m")["simulated"].to_numpy()
        np.testing.assert_allclose(values, values[::-1], rtol=1e-9)


def test_published_simulations_stand_beside_it_with_the_same_aims(validated, tmp_path):
    file = tmp_path / "peers.csv"
    file.write_text(
        "# published\nquantity,source,value,unit,reference\n"
        "voidage_error_rms,code A,0.121,1,a paper\nvoidage_error_rms,code B,0.044,1,a paper\n",
        encoding="utf-8",
    )
    metrics = pd.read_csv(validated(known_points(), peers=[file]) / "metrics.csv")
    rows = metrics[metrics["quantity"] == "voidage_error_rms"].set_index("source")
    assert rows["met"].to_dict() == {"dem": "yes", "code A": "no", "code B": "yes"}
    # a symmetric measurement, of which as much goes down as up
    measured = metrics[metrics["source"] == "measured"].set_index("quantity")["value"]
    assert measured["particle_velocity_asymmetry_rms"] == pytest.approx(0, abs=1e-9)
    assert abs(measured["solids_flux_15_mm"]) < 0.2 * measured["solids_flux_15_mm_size"]


def test_an_error_of_a_tenth_is_seen_as_such(validated):
    points = known_points()
    points.loc[points["quantity"] == "voidage_1", "value"] += 0.1
    metrics = pd.read_csv(validated(points) / "metrics.csv").set_index("quantity")
    assert metrics.loc["voidage_error_rms", "value"] == pytest.approx(0.1, abs=VOIDAGE_ERROR)
    assert metrics.loc["voidage_error_mean", "value"] == pytest.approx(-0.1, abs=VOIDAGE_ERROR)
    assert metrics.loc["particle_velocity_error_rms", "value"] < VELOCITY_ERROR


def test_a_window_that_was_not_simulated_is_refused(validated):
    with pytest.raises(DataError, match="2 s, is not the time of a frame"):
        validated(known_points(), 0.5, 2.0)


def test_points_of_an_unknown_quantity_are_refused(validated):
    with pytest.raises(UserError, match="unknown quantity temperature"):
        validated(known_points().assign(quantity="temperature"))
