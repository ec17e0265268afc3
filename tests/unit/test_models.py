# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain import dynamic, models
from bedchain.counting import Counts, count_moves, count_pairs, merge
from bedchain.estimators import ESTIMATORS
from bedchain.frames import DataError, Frames
from bedchain.grid import Grid
from bedchain.mixing import sides

ROUND_OFF = 1e-12
SIGMAS = 4.0
# Mean-square displacement of the persistent walk (rho = 0.8) after 50 steps, in cells squared.
PERSISTENT_MSD = 410.00057


def framed(cells: np.ndarray, grid: Grid) -> Frames:
    """Frames of particles in the middles of their cells."""
    x, z = np.moveaxis(grid.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells)) * 0.025, x, z, cells.astype(np.int32))


def stirred(seed: int = 0, n_frames: int = 60, n_particles: int = 400) -> tuple[Frames, Grid]:
    """Particles with a memory of their direction on a small bed."""
    rng = np.random.default_rng(seed)
    grid = Grid(0.05, 0.08, 5, 8)
    x, z = rng.random((2, n_particles)) * [[0.05], [0.08]]
    vx, vz = rng.normal(0, 0.004, (2, n_particles))
    frames = []
    for _ in range(n_frames):
        frames.append((x, z))
        vx, vz = 0.8 * vx + rng.normal(0, 0.003, n_particles), 0.8 * vz + rng.normal(0, 0.003, n_particles)
        x, z = np.clip(x + vx, 0, 0.05), np.clip(z + vz, 0, 0.08)
    x, z = np.moveaxis(np.array(frames), 1, 0)
    return Frames(np.arange(n_frames) * 0.025, x, z, grid.cell_of(x, z)), grid


def persistent_walk(n_cells: int, n_particles: int, n_frames: int, rng: np.random.Generator) -> np.ndarray:
    place = rng.integers(0, n_cells, n_particles)
    direction = rng.choice([-1, 1], n_particles)
    cells = np.empty((n_frames, n_particles), np.int32)
    for frame in range(n_frames):
        cells[frame] = place
        turned = (rng.random(n_particles) < 0.1) | (place + direction < 0) | (place + direction >= n_cells)
        direction = np.where(turned, -direction, direction)
        place = np.clip(place + direction, 0, n_cells - 1)
    return cells


def mean_square(chain: models.Chain, start: Frames, middle: int, steps: int) -> float:
    marked = np.ones((1, start.cells.shape[1]), bool)
    density = chain.densities(start, marked, [steps])[0, 0]
    return float(density @ (np.arange(density.size) - middle) ** 2 / density.sum())


def test_the_dynamic_chain_recovers_the_persistent_walk_exactly():
    # Every pair of neighbours, seen ten times: nine go on, one turns back.
    paths = [[i, i + d, i + 2 * d] for i in range(2, 119) for d in (-1, 1) for _ in range(9)]
    paths += [[i, i + d, i] for i in range(2, 119) for d in (-1, 1)]
    cells = np.array(paths, np.int32).T
    grid = Grid(1.21, 0.01, 121, 1)
    start = framed(np.array([[59, 61], [60, 60]]), grid)
    chain = models.learn("dynamic", framed(cells, grid), grid)
    assert mean_square(chain, start, 60, 50) == pytest.approx(PERSISTENT_MSD, abs=1e-5)
    first_order = models.learn("static", framed(cells, grid), grid)
    assert mean_square(first_order, start, 60, 50) == pytest.approx(50, abs=1e-9)


def test_the_dynamic_chain_recovers_the_persistent_walk_from_frames():
    rng = np.random.default_rng(12)
    grid = Grid(2.01, 0.01, 201, 1)
    frames = framed(persistent_walk(201, 20_000, 100, rng), grid)
    start = framed(np.array([[99, 101], [100, 100]]), grid)
    expected = {"dynamic": (PERSISTENT_MSD, 0.03), "static": (50.0, 0.03)}
    for name, (displacement, tolerance) in expected.items():
        found = mean_square(models.learn(name, frames, grid), start, 100, 50)
        assert found == pytest.approx(displacement, rel=tolerance), name


@pytest.mark.parametrize("estimator", list(ESTIMATORS))
def test_a_constant_process_gives_static_equal_to_dynamic(estimator):
    grid = Grid(0.04, 0.03, 4, 3)
    rng = np.random.default_rng(1)
    still = np.tile(rng.integers(0, 12, 50), (20, 1))
    shift = (rng.integers(0, 12, 50) + np.arange(21)[:, None] * 5) % 12
    for cells in (still, shift):
        frames = framed(cells, grid)
        if estimator == "literal":
            # All cells hold particles all the time, or they leak at different rates.
            frames = framed(np.concatenate([cells, (np.arange(12) + cells[:, :1] - cells[0, 0]) % 12], axis=1), grid)
        start = frames.part(slice(0, 2))
        curves = [models.learn(name, frames, grid, 1, estimator).mixing(start, 0.02, 0.01, 15) for name in models.LEARNERS]
        assert np.allclose(curves[0], curves[1], rtol=0, atol=ROUND_OFF, equal_nan=True)


def test_pairs_seen_once_follow_what_they_did():
    grid = Grid(0.03, 0.01, 3, 1)
    cells = np.array([[0, 1, 2, 1, 0, 1, 2, 1, 0]]).T
    chain = models.learn("dynamic", framed(cells, grid), grid)
    assert [int(c[0]) for c in chain.paths(framed(cells[:2], grid), 6, np.random.default_rng(1))] == [1, 2, 1, 0, 1, 2, 1]


def test_an_unknown_pair_falls_back_on_the_static_row():
    grid = Grid(0.04, 0.01, 4, 1)
    cells = np.array([[0, 1, 2, 1, 0, 1, 2, 1, 0], [2, 1, 0, 1, 2, 1, 0, 1, 2]]).T
    learned = framed(cells, grid)
    static, chain = (models.learn(name, learned, grid) for name in ("static", "dynamic"))
    marked = np.ones((1, 1), bool)
    for before in (1, 3):  # never (1, 1) nor (3, 1)
        start = framed(np.array([[before], [1]]), grid)
        one = [model.densities(start, marked, [1])[0, 0].tolist() for model in (static, chain)]
        assert one[0] == one[1] == [0.5, 0, 0.5, 0]
    never = framed(np.array([[3], [3]]), grid)
    assert chain.densities(never, marked, [9])[0, 0].tolist() == [0, 0, 0, 1.0]


def test_dynamic_matrix_agrees_with_a_loop_over_pairs():
    frames, grid = stirred(3)
    chain = models.learn("dynamic", frames, grid)
    start = frames.part(slice(10, 12))
    path = frames.cells
    expected = np.zeros(grid.n_cells)
    for p in range(path.shape[1]):
        same = (path[:-2] == path[10, p]) & (path[1:-1] == path[11, p])
        expected += np.bincount(path[2:][same], minlength=grid.n_cells) / same.sum()
    found = chain.densities(start, np.ones((1, path.shape[1]), bool), [1])[0, 0]
    assert np.allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize("name", list(models.LEARNERS))
@pytest.mark.parametrize("estimator", list(ESTIMATORS))
def test_every_chain_conserves_mass_and_repeats_by_seed(name, estimator):
    frames, grid = stirred(1)
    start = frames.part(slice(30, 34))
    chain = models.learn(name, frames, grid, lag=2, estimator=estimator)
    assert chain.lag_s == pytest.approx(0.05) and chain.name == name
    marked = sides(start.x_m[-1], start.z_m[-1], 0.02, 0.05)
    density = chain.densities(start, marked, [0, 1, 1000])
    assert np.abs(density.sum(axis=2) - marked.sum(axis=1)).max() < 1e-9
    counts = [chain.densities(start, marked, [0, 3, 7], np.random.default_rng(5)) for _ in range(2)]
    assert counts[0].dtype == np.int64 and (counts[0] == counts[1]).all()
    assert (counts[0].sum(axis=2) == marked.sum(axis=1)).all() and (counts[0][0] == density[0]).all()
    assert chain.long_run_density(start).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("name", list(models.LEARNERS))
def test_monte_carlo_curves_agree_with_the_exact_ones(name):
    frames, grid = stirred(2, n_particles=20_000)
    start = frames.part(slice(20, 24))
    chain = models.learn(name, frames, grid)
    exact = chain.mixing(start, 0.025, 0.045, 30)
    drawn = chain.mixing(start, 0.025, 0.045, 30, np.random.default_rng(6))
    size = sides(start.x_m[-1], start.z_m[-1], 0.025, 0.045).sum(axis=1)
    error = np.sqrt(exact * (1 - exact) / size)
    assert exact[0].tolist() == drawn[0].tolist() == [1, 1, 1, 1]
    assert (np.abs(drawn - exact)[1:] < SIGMAS * error[1:]).all()
    assert (np.abs(drawn - exact)[1:] > 0).any()


def test_curves_follow_from_densities():
    frames, grid = stirred(4)
    start = frames.part(slice(8, 10))
    marked = sides(start.x_m[-1], start.z_m[-1], 0.03, 0.05)
    for name in models.LEARNERS:
        chain = models.learn(name, frames, grid)
        density = chain.densities(start, marked, range(1, 20))
        x, z = grid.centres_m.T
        for g, on_side in enumerate((x < 0.03, x > 0.03, z < 0.05, z > 0.05)):
            share = density[:, g, on_side].sum(axis=1) / marked[g].sum()
            assert np.allclose(chain.mixing(start, 0.03, 0.05, 19)[1:, g], share, atol=1e-10)


@pytest.mark.parametrize("name", list(models.LEARNERS))
def test_files_give_back_the_same_chain(name, tmp_path):
    frames, grid = stirred(5)
    chain = models.learn(name, frames, grid, 1, "per_step")
    models.save(chain, tmp_path / "chain.npz")
    again = models.load(tmp_path / "chain.npz")
    for key, array in chain.arrays().items():
        assert array.dtype == again.arrays()[key].dtype and (array == again.arrays()[key]).all(), key
    assert (again.name, again.grid, again.lag_s, again.report) == (chain.name, chain.grid, chain.lag_s, chain.report)
    assert [file.name for file in tmp_path.iterdir()] == ["chain.npz"]
    first, second = tmp_path / "chain.npz", tmp_path / "again.npz"
    models.save(again, second)
    assert first.read_bytes() == second.read_bytes()


def test_unreadable_files_are_refused(tmp_path):
    frames, grid = stirred(6)
    path = tmp_path / "chain.npz"
    models.save(models.learn("static", frames, grid), path)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(DataError, match="cannot be read"):
        models.load(path)
    np.savez(path, name=np.array("wind"))
    with pytest.raises(DataError, match="no chain of a known model"):
        models.load(path)
    np.savez(path, name=np.array("static"))
    with pytest.raises(DataError, match="lacks 'bed_m'"):
        models.load(path)
    with pytest.raises(DataError, match="cannot be read"):
        models.load(tmp_path / "absent.npz")


def test_nothing_is_left_behind_when_writing_fails(tmp_path):
    frames, grid = stirred(7)
    chain = models.learn("static", frames, grid)
    chain.report["odd"] = {1, 2}  # not representable in the file
    with pytest.raises(TypeError):
        models.save(chain, tmp_path / "chain.npz")
    assert list(tmp_path.iterdir()) == []


def test_windows_and_starts_too_short_are_refused():
    frames, grid = stirred(8, n_frames=6)
    with pytest.raises(DataError, match="model 'wind' is unknown: choose from static, dynamic"):
        models.learn("wind", frames, grid)
    with pytest.raises(DataError, match="hold no step"):
        models.learn("dynamic", frames, grid, lag=3)
    chain = models.learn("dynamic", frames, grid, lag=2)
    with pytest.raises(DataError, match="starts from 3 frames, 2 given"):
        chain.mixing(frames.part(slice(0, 2)), 0.02, 0.05, 3)


def test_merged_parts_make_the_same_dynamic_chain():
    frames, grid = stirred(9)
    cells = frames.cells

    def parts(count) -> Counts:
        return merge([count(cells, grid.n_cells, first=low, last=low + 10) for low in range(0, 60, 10)][:6])

    whole = models.learn("dynamic", frames, grid)
    joined = dynamic.from_counts(parts(count_pairs), parts(count_moves), grid, 0.025)
    for key, array in whole.arrays().items():
        assert (array == joined.arrays()[key]).all(), key


def test_a_pair_entered_only_at_the_end_moves_on_as_its_cell_does():
    grid = Grid(0.03, 0.01, 3, 1)
    to_and_fro = [[0, 1] * 4] * 6
    cells = np.array([*to_and_fro, [0, 1, 0, 1, 0, 2, 2, 2]]).T
    chain = models.learn("dynamic", framed(cells, grid), grid)
    assert chain.report["pairs_opened_1"] == 1
    density = chain.long_run_density(framed(cells[:2], grid))
    assert density[2] < 0.2 and density.sum() == pytest.approx(1)
