# SPDX-License-Identifier: GPL-3.0-or-later
"""A drum of LIGGGHTS: its VTK files are its text frames; sectors and boxes mix alike, within their bands."""

from functools import partial

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.chains import static
from bedchain.chains.counting import count_moves
from bedchain.trajectory.frames import Frames, Window
from bedchain.trajectory.frames_of_case import measured_sections
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.imported import Targets
from bedchain.trajectory.realisations import open_realisation
from bedchain.uncertainty.bands import block_band, kept_blocks, kept_steps
from import_frames import Box, Tables, import_frames
from made.decks import run_deck

INTERVAL_S, DIAMETER, DEPTH = 0.04, 0.06, 0.012
LAG, STARTED, STEPS = 5, 25, 10  # a fifth of a revolution; after one revolution; two revolutions
BOXES = Grid(DIAMETER, DIAMETER, 6, 6)
SECTORS = Grid(DIAMETER, DIAMETER, 12, 3, DEPTH, form="sectors", axis="horizontal")
DEEP = Grid(DIAMETER, DIAMETER, 12, 3, DEPTH, 2, form="sectors", axis="horizontal")
SPLITS = (DIAMETER / 2, 0.015)
CUT = 0.08  # seen: 0.05 at most


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folder with the files of the drum, and its text frames."""
    folder = tmp_path_factory.mktemp("drum")
    return folder, run_deck("in.drum", folder, across="y")


@pytest.fixture(scope="module")
def drum(made):
    """Positions x, z, y of all frames after one revolution [m]."""
    values = made[1].values[STARTED:]
    return values[:, 0], values[:, 1], values[:, 4]


def test_a_short_case_takes_the_drum_from_its_vtk_files_to_mixing_curves(made, tmp_path):
    folder, scene = made
    (file := tmp_path / "case.yaml").write_text(f"""
title: drum
frames: {{files: "{folder}/drum_*.vtk", step_s: 1.25e-4, across: y}}
bed: {{width_m: {DIAMETER}, height_m: {DIAMETER}, thickness_m: {DEPTH}}}
cells: {{columns: 6, rows: 6}}
learning: {{start_s: 0.4, end_s: 4}}
comparison: {{start_s: 4, end_s: 7.8}}
mixing: {{split_z_m: 0.015}}
""")
    case = load_case(file, measure=partial(measured_sections, cache=tmp_path / "frames.json"))
    section = case["frames"] | {"origin_m": [0.0, 0.0, 0.0]}
    targets = Targets(*(tmp_path / name for name in ("trajectory.npy", "trajectory.json", "particles.npz")))
    tables = Tables(tmp_path / "bed_series.csv", tmp_path / "motion.csv")
    import_frames(section, tmp_path, Box(DIAMETER, DIAMETER, "refuse"), targets, tables, progress=False)
    run = open_realisation("the run", targets.trajectory, targets.metadata)
    text = scene.values[2::5]  # of the same steps: each 320 from 2560 on, and each 1600
    assert run.values.shape[::2] == (40, text.shape[2]) and run.interval_s == pytest.approx(0.2)
    # both forms have six digits, of velocities that are differences of larger ones too
    np.testing.assert_allclose(run.values[:, :2], text[:, :2], atol=2e-7)
    np.testing.assert_allclose(run.values[:, 2:4], text[:, 2:4], rtol=2e-5, atol=1e-6)
    learned = run.frames(BOXES, Window(**case["learning"]).frames(run.times_s))
    start = run.leading_to(BOXES, 18, 1)
    curves = static.learn(learned, BOXES).mixing(start, DIAMETER / 2, 0.015, 19)
    # mixed: who was left is as often left as who was right
    assert (curves[0] == 1).all() and curves[-1, :2].sum() == pytest.approx(1, abs=0.1)


def mixing_with_bands(grid, drum):
    """Mixing curves of a static chain of a grid, and their bands, (STEPS + 1, 4)."""
    x, z, y = drum
    cells = grid.cell_of(x, z, y_m=y)
    frames = Frames(INTERVAL_S * np.arange(len(x)), x, z, cells, y_m=y)
    start, n_steps = frames.part(slice(0, 1)), len(x) - LAG

    def curves(weights):
        counts = count_moves(cells, grid.n_cells, LAG, step_weights=weights)
        return static.from_counts(counts, grid, LAG * INTERVAL_S).mixing(start, *SPLITS, STEPS)

    left_out = np.stack([curves(kept_steps(kept, n_steps)) for kept in kept_blocks()])
    whole = curves(np.ones(n_steps, int))
    return whole, *block_band(whole, left_out)


def test_chains_on_sectors_and_on_boxes_agree_within_their_bands(drum):
    (boxes, low, high), (sectors, other_low, other_high), (deep, *ends) = (
        mixing_with_bands(grid, drum) for grid in (BOXES, SECTORS, DEEP)
    )
    assert (boxes[0] == 1).all() and (boxes[-1] < 0.8).any()
    late = slice(1, None)
    alike = np.maximum(low, other_low)[late] <= np.minimum(high, other_high)[late]
    assert alike[:, :2].all()  # left and right: the line lies on borders of both
    # low and up: the line cuts cells, of other sizes in both grids, and no band knows of that
    np.testing.assert_allclose(boxes[late, 2:], sectors[late, 2:], atol=CUT)
    # cells along the depth change nothing that is seen from the front
    assert (np.maximum(ends[0], other_low)[late] <= np.minimum(ends[1], other_high)[late]).all()
    np.testing.assert_allclose(deep[-1], sectors[-1], atol=0.05)


def test_a_sector_holds_what_its_box_of_places_holds(drum):
    x, z, y = (part[-1] for part in drum)
    held = np.bincount(SECTORS.cell_of(x, z, y_m=y), minlength=SECTORS.n_cells)
    angle, r = np.arctan2(x - DIAMETER / 2, DIAMETER / 2 - z), np.hypot(x - DIAMETER / 2, z - DIAMETER / 2)
    bins = [np.linspace(0, DIAMETER / 2, 4), np.linspace(-np.pi, np.pi, 13)]
    np.testing.assert_array_equal(held.reshape(3, 12), np.histogram2d(r, angle, bins)[0])
