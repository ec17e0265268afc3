# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import dynamic, registry
from bedchain.chains.counting import count_moves, count_pairs
from bedchain.chains.estimators import ESTIMATORS
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.measures.mixing import marked_histogram, sides
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import kept_blocks, kept_steps
from made.frames import stirred

# Monte Carlo against the exact mean, in standard errors; about 1 in 15 000 exceeds it by chance.
SIGMAS = 4.0
# All tracers of a recurrence chain share one path: its curves are no dice of independent particles.
INDEPENDENT = [name for name in registry.LEARNERS if name != "recurrence"]


@pytest.mark.parametrize("name", list(registry.LEARNERS))
@pytest.mark.parametrize("estimator", list(ESTIMATORS))
def test_every_chain_conserves_mass_and_repeats_by_seed(name, estimator):
    frames, grid = stirred(1)
    start = frames.part(slice(30, 34))
    chain = registry.learn(name, frames, grid, lag=2, estimator=estimator)
    assert chain.lag_s == pytest.approx(0.05) and chain.name == name
    marked = sides(start.x_m[-1], start.z_m[-1], 0.02, 0.05)
    many = 1000 if isinstance(chain, MarkovChain) else 20
    density = chain.densities(start, marked, [0, 1, many])
    assert np.abs(density.sum(axis=2) - marked.sum(axis=1)).max() < 1e-9
    counts = [chain.densities(start, marked, [0, 3, 7], np.random.default_rng(5)) for _ in range(2)]
    assert counts[0].dtype == np.int64 and (counts[0] == counts[1]).all()
    assert (counts[0].sum(axis=2) == marked.sum(axis=1)).all() and (counts[0][0] == density[0]).all()
    paths = [np.array([c.copy() for c in chain.paths(start, 7, np.random.default_rng(5))]) for _ in "ab"]
    assert (paths[0] == paths[1]).all() and paths[0].min() >= 0 and paths[0].max() < grid.n_cells
    assert (paths[0][-1] != list(chain.paths(start, 7, np.random.default_rng(6)))[-1]).any()
    assert chain.long_run_density(start).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("name", INDEPENDENT)
def test_monte_carlo_curves_agree_with_the_exact_ones(name):
    frames, grid = stirred(2, n_particles=20_000)
    start = frames.part(slice(20, 24))
    chain = registry.learn(name, frames, grid)
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
    for name in registry.LEARNERS:
        chain = registry.learn(name, frames, grid)
        density = chain.densities(start, marked, range(1, 20))
        x, z = grid.centres_m.T
        for g, on_side in enumerate((x < 0.03, x > 0.03, z < 0.05, z > 0.05)):
            share = density[:, g, on_side].sum(axis=1) / marked[g].sum()
            assert np.allclose(chain.mixing(start, 0.03, 0.05, 19)[1:, g], share, atol=1e-10)


@pytest.mark.parametrize("name", list(registry.LEARNERS))
def test_files_give_back_the_same_chain(name, tmp_path):
    frames, grid = stirred(5)
    chain = registry.learn(name, frames, grid, 1, "per_step")
    registry.save(chain, tmp_path / "chain.npz")
    again = registry.load(tmp_path / "chain.npz")
    for key, array in chain.arrays().items():
        assert array.dtype == again.arrays()[key].dtype and (array == again.arrays()[key]).all(), key
    assert (again.name, again.grid, again.lag_s, again.report) == (
        chain.name,
        chain.grid,
        chain.lag_s,
        chain.report,
    )
    assert [file.name for file in tmp_path.iterdir()] == ["chain.npz"]
    first, second = tmp_path / "chain.npz", tmp_path / "again.npz"
    registry.save(again, second)
    assert first.read_bytes() == second.read_bytes()


def test_unreadable_files_are_refused(tmp_path):
    frames, grid = stirred(6)
    path = tmp_path / "chain.npz"
    registry.save(registry.learn("static", frames, grid), path)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(DataError, match="cannot be read"):
        registry.load(path)
    np.savez(path, name=np.array("wind"))
    with pytest.raises(DataError, match="no chain of a known model"):
        registry.load(path)
    np.savez(path, name=np.array("static"))
    with pytest.raises(DataError, match="no array 'bed_m'"):
        registry.load(path)
    with pytest.raises(DataError, match="cannot be read"):
        registry.load(tmp_path / "absent.npz")


def test_nothing_is_left_behind_when_writing_fails(tmp_path):
    frames, grid = stirred(7)
    chain = registry.learn("static", frames, grid)
    chain.report["odd"] = {1, 2}  # not representable in the file
    with pytest.raises(TypeError):
        registry.save(chain, tmp_path / "chain.npz")
    assert list(tmp_path.iterdir()) == []


def test_windows_and_starts_too_short_are_refused():
    frames, grid = stirred(8, n_frames=6)
    with pytest.raises(DataError, match="model 'wind' is unknown: choose from static, dynamic"):
        registry.learn("wind", frames, grid)
    with pytest.raises(DataError, match="hold no step"):
        registry.learn("dynamic", frames, grid, lag=3)
    chain = registry.learn("dynamic", frames, grid, lag=2)
    with pytest.raises(DataError, match="starts from 3 frames, 2 given"):
        chain.mixing(frames.part(slice(0, 2)), 0.02, 0.05, 3)


@pytest.mark.parametrize("name", list(registry.LEARNERS))
def test_one_cell_and_one_cell_a_diameter(name):
    frames, _ = stirred(10)
    for grid in (Grid(0.05, 0.08, 1, 1), Grid(0.05, 0.08, 50, 80)):
        grid.check_resolution(0.001)
        seen = Frames(frames.times_s, frames.x_m, frames.z_m, grid.cell_of(frames.x_m, frames.z_m))
        chain = registry.learn(name, seen, grid)
        curves = chain.mixing(seen.part(slice(0, 3)), 0.025, 0.04, 5)
        assert curves.shape == (6, 4) and ((curves >= 0) & (curves <= 1)).all()


@pytest.mark.parametrize("name", list(registry.LEARNERS))
@pytest.mark.parametrize("estimator", list(ESTIMATORS))
def test_learning_again_without_a_block_is_learning_without_it(name, estimator):
    frames, grid = stirred(12, n_frames=30)
    again = registry.relearner(name, frames, grid, 2, estimator)
    for kept in (np.ones(5, bool), *kept_blocks()[:2]):
        weights = kept_steps(kept, 28)
        one, two = again(kept), registry.learn(name, frames, grid, 2, estimator, weights)
        if name == "dynamic":
            # its pairs of moves are fewer by a lag, and have blocks of their own
            double = count_pairs(frames.cells, grid.n_cells, 2, kept_steps(kept, 26))
            single = count_moves(frames.cells, grid.n_cells, 2, step_weights=weights)
            two = dynamic.from_counts(double, single, grid, two.lag_s, estimator)
        assert one.lag_s == two.lag_s and one.report == pytest.approx(two.report, abs=1e-12)
        for key, array in one.arrays().items():
            if array.dtype.kind == "f":
                assert np.allclose(array, two.arrays()[key], rtol=0, atol=1e-12), key
            elif key != "report":
                assert (array == two.arrays()[key]).all(), key


class Still:
    """A path model that keeps positions and not only cells: particles never move."""

    def __init__(self, grid: Grid, lag_s: float) -> None:
        self.name, self.grid, self.lag_s, self.report = "still", grid, lag_s, {"tracers_1": 1.0}

    def mixing(self, start, split_x_m, split_z_m, steps, rng=None):
        marked = sides(start.x_m[-1], start.z_m[-1], split_x_m, split_z_m)
        return np.where(marked.any(axis=1), 1.0, np.nan) * np.ones((steps + 1, 1))

    def densities(self, start, marked, steps, rng=None):
        return np.stack([marked_histogram(start.cells[-1], marked, self.grid.n_cells) for _ in steps])

    def paths(self, start, steps, rng):
        return iter([start.cells[-1]] * (steps + 1))

    def long_run_density(self, start):
        return np.bincount(start.cells[-1], minlength=self.grid.n_cells) / start.cells.shape[1]

    def arrays(self):
        return {"grid": np.array([self.grid.columns, self.grid.rows]), "lag_s": np.array(self.lag_s)}


def test_a_model_of_another_kind_needs_nothing_but_its_two_entries(monkeypatch, tmp_path):
    frames, grid = stirred(11)

    def learn(frames, grid, lag=1, estimator="pooled", step_weights=None, speed=0):
        return Still(grid, lag * frames.interval_s)

    def read(arrays):
        return Still(Grid(0.05, 0.08, *(int(n) for n in arrays["grid"])), float(arrays["lag_s"]))

    monkeypatch.setitem(registry.LEARNERS, "still", learn)
    monkeypatch.setitem(registry.READERS, "still", read)
    start = frames.part(slice(8, 12))
    for name in registry.LEARNERS:
        options = {"speed": 0} if name == "still" else {}
        registry.save(registry.learn(name, frames, grid, **options), tmp_path / f"transitions_{name}.npz")
        chain = registry.load(tmp_path / f"transitions_{name}.npz")
        marked = sides(start.x_m[-1], start.z_m[-1], 0.02, 0.05)
        assert chain.mixing(start, 0.02, 0.05, 4).shape == (5, 4)
        assert chain.densities(start, marked, [0, 4]).sum(axis=2) == pytest.approx(
            np.tile(marked.sum(axis=1), (2, 1))
        )
        assert len(list(chain.paths(start, 4, np.random.default_rng(1)))) == 5
