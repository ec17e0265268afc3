# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeats of a run: the same state at first, but for a small known change, and another course afterwards."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.dem.repeats import KICK_M_S
from bedchain.dem.run import repeat_dem, run_dem
from bedchain.errors import UserError
from bedchain.trajectory.dumps import read_dump

COLUMNS = ["id", "x", "z", "vx", "vz"]
START, END, SEGMENT = 0.04, 0.06, 0.02
# relative, of the kinetic energy over the first steps: contacts are summed in another order, and another
# number of ranks solves the gas to another round-off
SAME_STATE = 1e-4
FIRST_S = 0.01


def frames_of(folder):
    """Frames by time, particles by id."""
    listed = json.loads((folder / "dem.json").read_text())
    tables = {}
    for frame in listed["frames"]:
        values = read_dump(folder / frame["file"], COLUMNS).values
        tables[round(frame["time_s"], 6)] = values[np.argsort(values[:, 0])]
    return tables


def energy(folder, start_s, end_s):
    """Kinetic energy after a time, up to another [J]."""
    series = pd.read_csv(folder / "bed_series.csv")
    return series.loc[series["time_s"].between(start_s + 1e-9, end_s + 1e-9), "kinetic_energy_J"].to_numpy()


@pytest.mark.parametrize(("ranks", "repeat_ranks"), [(1, 1), (2, 2), (1, 2), (2, 1)])
def test_a_repeat_that_is_not_perturbed_follows_the_run(make_bed, ranks, repeat_ranks):
    folder = make_bed("bed")
    run_dem(folder, END, SEGMENT, ranks)
    repeat_dem(folder, START, END, SEGMENT, repeat_ranks, 1, kick_m_s=0.0)
    whole, again = frames_of(folder), frames_of(folder / "repeats" / "1")
    np.testing.assert_array_equal(again[START], whole[START])
    first = [energy(path, START, START + FIRST_S) for path in (folder, folder / "repeats" / "1")]
    assert len(first[0]) > 1
    np.testing.assert_allclose(first[1], first[0], rtol=SAME_STATE)


def test_repeats_begin_alike_but_for_the_kick_and_part(make_bed):
    folder = make_bed("bed")
    run_dem(folder, END, SEGMENT, 1)
    before = {file: file.stat().st_mtime_ns for file in (folder / "dem").rglob("*") if file.is_file()}
    for number in (1, 2):
        repeat_dem(folder, START, END, SEGMENT, 1, number)
    whole = frames_of(folder)
    one, two = (frames_of(folder / "repeats" / str(number)) for number in (1, 2))
    assert list(one) == [time for time in whole if time >= START]
    for other in (one, two):
        np.testing.assert_array_equal(other[START][:, :3], whole[START][:, :3])
        kicks = other[START][:, 3:] - whole[START][:, 3:]
        assert np.abs(kicks).max() <= KICK_M_S * (1 + 1e-9)
        # an even distribution; with 600 numbers its rms is known to 3 %
        assert kicks.std() == pytest.approx(KICK_M_S / 3**0.5, rel=0.12)
        assert np.abs(other[END][:, 1:3] - whole[END][:, 1:3]).max() > 1e-6
    assert not np.array_equal(one[START], two[START])
    assert {file: file.stat().st_mtime_ns for file in before} == before


def test_a_finished_repeat_is_left_alone(make_bed):
    folder = make_bed("bed")
    run_dem(folder, END, SEGMENT, 1)
    repeat_dem(folder, START, END, SEGMENT, 1, 1)
    state = folder / "repeats" / "1" / "dem"
    before = {file: file.stat().st_mtime_ns for file in state.rglob("*/*") if file.is_file()}
    repeat_dem(folder, START, END, SEGMENT, 1, 1)
    assert {file: file.stat().st_mtime_ns for file in before} == before


def test_a_repeat_starts_at_the_end_of_a_segment(make_bed):
    folder = make_bed("bed")
    run_dem(folder, END, SEGMENT, 1)
    with pytest.raises(UserError, match=r"no segment .* ends at 0.044 s.*take 0.04 s"):
        repeat_dem(folder, 0.044, END, SEGMENT, 1, 1)
    assert not (folder / "repeats").exists()


def test_a_repeat_needs_the_run(make_bed):
    folder = make_bed("bed")
    with pytest.raises(UserError, match="run run_dem"):
        repeat_dem(folder, START, END, SEGMENT, 1, 1)
