# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in the store: axes, units, corner, ids, properties, and every fault of a frame named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.bed_frames import Placement
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.frame_files import FrameSettings
from bedchain.trajectory.imported import Targets, write_imported
from bedchain.trajectory.particles import read_particles
from bedchain.trajectory.store import open_trajectory
from bedchain.trajectory.survey import survey
from made.forms import BOX, COLUMNS, FORMS, STEP_S, Series, moving, text_frame, write_form

SERIES = moving()
ORDER = np.argsort(SERIES.ids)
LOW, SIZE = BOX[:, 0], BOX[:, 1] - BOX[:, 0]
PLACE = Placement("x", "z", tuple(LOW), SIZE[0], SIZE[2])


def stored(tmp_path: Path, pattern: str = "*", placement: Placement = PLACE, **more):
    settings = FrameSettings(str(pattern), step_s=STEP_S, **more)
    targets = Targets(*(tmp_path / "out" / n for n in ("trajectory.npy", "trajectory.json", "particles.npz")))
    write_imported(survey(settings, tmp_path / "in"), settings, placement, targets, progress=False)
    left = {file.name for file in (tmp_path / "out").iterdir()}
    assert left == {"trajectory.npy", "trajectory.json", "particles.npz"}
    return (*open_trajectory(*targets[:2]), read_particles(targets.trajectory))


@pytest.mark.parametrize("form", FORMS)
def test_every_form_makes_the_same_store(tmp_path, form):
    pattern = write_form(form, tmp_path / "in", SERIES)
    names = COLUMNS if form == "binary" else None
    store, about, particles = stored(tmp_path, pattern, reading=FormSettings(names=names))
    expected = np.stack((SERIES.positions[:, :, 0] - LOW[0], SERIES.positions[:, :, 2] - LOW[2]), axis=1)
    assert store[:, :2] == pytest.approx(expected[:, :, ORDER], abs=3e-8)
    assert store[:, 2] == pytest.approx(SERIES.velocities[:, ORDER, 0], rel=1e-6)
    assert about["times_s"] == pytest.approx(SERIES.steps * STEP_S) and about["complete"]
    assert particles.ids.tolist() == SERIES.ids[ORDER].tolist()
    assert particles.type.tolist() == SERIES.types[ORDER].tolist()
    assert particles.radius_m == pytest.approx(SERIES.radii)


def test_axes_turn_and_the_third_one_is_kept_where_wanted(tmp_path):
    write_form("text", tmp_path / "in", SERIES)
    corner = (LOW[1], LOW[0], -BOX[2, 1])
    turned = Placement("y", "-z", corner, SIZE[1], SIZE[2], keep_depth=True)
    store, about, _ = stored(tmp_path, placement=turned)
    assert about["columns"] == ["x", "z", "vx", "vz", "y"] and about["depth_m"] == pytest.approx(SIZE[0])
    assert store[:, 0] == pytest.approx(SERIES.positions[:, ORDER, 1] - LOW[1], abs=1e-8)
    assert store[:, 1] == pytest.approx(BOX[2, 1] - SERIES.positions[:, ORDER, 2], abs=1e-8)
    assert store[:, 3] == pytest.approx(-SERIES.velocities[:, ORDER, 2], rel=1e-6)
    assert store[:, 4] == pytest.approx(SERIES.positions[:, ORDER, 0] - LOW[0], abs=1e-8)


def test_millimetres_become_metres(tmp_path):
    scaled = SERIES._replace(
        positions=SERIES.positions * 1000, velocities=SERIES.velocities * 1000, radii=SERIES.radii * 1000
    )
    write_form("npz", tmp_path / "in", scaled)
    store, _, particles = stored(tmp_path, length_unit_m=1e-3)
    assert store[:, 0] == pytest.approx(SERIES.positions[:, ORDER, 0] - LOW[0], abs=1e-8)
    assert store[:, 2] == pytest.approx(SERIES.velocities[:, ORDER, 0], rel=1e-6)
    assert particles.radius_m == pytest.approx(5e-4)


def without(series: Series, frame: int, gone: int) -> str:
    keep = np.arange(len(series.ids)) != gone
    return text_frame(
        Series(series.positions[:, keep], series.velocities[:, keep], series.steps, *(
            array[keep] for array in (series.ids, series.types, series.radii)
        )), frame,
    )  # fmt: skip


def write_lossy(folder: Path) -> None:
    """Frames in which the first particle of the series comes late and the last one goes early."""
    folder.mkdir()
    last = len(SERIES.ids) - 1
    for frame in range(6):
        text = without(SERIES, frame, 0) if frame < 2 else text_frame(SERIES, frame)
        (folder / f"f{frame}").write_text(without(SERIES, frame, last) if frame > 3 else text)


def test_particles_that_come_and_go_are_refused_or_kept_apart(tmp_path):
    write_lossy(tmp_path / "in")
    late, early = SERIES.ids[0], SERIES.ids[-1]
    with pytest.raises(
        UserError, match=rf"f2, step 2000: other particles than in the first frame \(new: id {late}\)"
    ):
        stored(tmp_path)
    assert not list((tmp_path / "out").iterdir())
    store, about, particles = stored(tmp_path, placement=replace(PLACE, outside="exit"))
    assert not about["complete"] and particles.ids.tolist() == sorted(SERIES.ids)
    absent = np.isnan(store).all(axis=1)
    expected = np.zeros((6, 20), bool)
    expected[:2, np.searchsorted(particles.ids, late)] = expected[
        4:, np.searchsorted(particles.ids, early)
    ] = True
    assert (absent == expected).all() and (np.isnan(store).any(axis=1) == expected).all()
    assert store[5, 0][~absent[5]] == pytest.approx(
        np.delete(SERIES.positions[5, ORDER, 0] - LOW[0], np.flatnonzero(absent[5])), abs=1e-8
    )


CHANGES = {
    "nan": (lambda s: s.positions.__setitem__((3, 4, 0), np.nan), "x of 1 particles is no finite number: id"),
    "doubled": (lambda s: s.ids.__setitem__(1, s.ids[0]), "two particles have the id"),
    "outside": (lambda s: s.positions.__setitem__((3, 4, 2), 0.5), "1 of 20 particles are outside the bed"),
    "units": (
        lambda s: s.positions.__imul__(1000),
        "20 of 20 particles are outside the bed, .*length_unit_m",
    ),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_frame_with_a_fault_is_refused(tmp_path, change):
    broken = Series(*(array.copy() for array in moving()))
    CHANGES[change][0](broken)
    write_form("text", tmp_path / "in", broken)
    with pytest.raises(UserError, match=rf"step \d+: {CHANGES[change][1]}"):
        stored(tmp_path)
