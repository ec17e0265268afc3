# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of the Markov core beside deeptime and a scipy call: the table of scripts/README.md."""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# One thread each: threads of a numerical library that wait for each other would be timed as work.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pandas as pd
from scipy import sparse

from bedchain.chains import dynamic, propagate, registry, static
from bedchain.chains.counting import count_moves, count_pairs
from bedchain.chains.estimators import transition_matrix
from bedchain.files import write_csv
from bedchain.meter import peak_memory_mb
from bedchain.studies.cost.benchmark_table import machine, relative_rows, table
from bedchain.trajectory import synthetic
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

INTERVAL_S = 0.025
SEED = 15013
PAPER_CELLS, FINE_CELLS = (27, 105), (270, 1050)
# models that are learned from positions
PLACED = ("velocity_class", "jump", "recurrence")
FIELDS = (
    *("work", "method", "particles", "steps", "columns", "rows", "median_s", "cpu_s"),
    *("peak_rss_mb", "own_rss_mb", "entries", "repeats", "target", "met"),
)


@dataclass(frozen=True)
class Task:
    """A line of the table."""

    work: str
    method: str
    particles: int
    steps: int
    cells: tuple[int, int]
    repeats: int
    limit_s: float = float("inf")
    limit_mb: float = float("inf")


def grid_of(cells: tuple[int, int]) -> Grid:
    """Cells over the paper's bed."""
    return Grid(0.27, 1.05, *cells)


def frames_of(cells: np.ndarray, grid: Grid) -> Frames:
    """Frames of particles in the middles of their cells."""
    x, z = np.moveaxis(grid.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells), dtype=np.float64) * INTERVAL_S, x, z, cells)


def static_matrix(cells: np.ndarray, grid: Grid) -> Callable[[], sparse.csr_array]:
    """Counts and matrix of the static chain, as bedchain makes them."""
    return lambda: transition_matrix(count_moves(cells, grid.n_cells))


def scipy_matrix(cells: np.ndarray, grid: Grid) -> Callable[[], sparse.csr_array]:
    """The same by one call of scipy."""

    def run() -> sparse.csr_array:
        before, after = np.asarray(cells[:-1]).ravel(), np.asarray(cells[1:]).ravel()
        counts = sparse.coo_array((np.ones(before.size), (before, after)), shape=(grid.n_cells,) * 2).tocsr()
        sums = counts.sum(axis=1)
        return sparse.csr_array(sparse.diags_array(1.0 / np.where(sums > 0, sums, 1.0)) @ counts)

    return run


def deeptime_matrix(cells: np.ndarray, grid: Grid) -> Callable[[], sparse.csr_array]:
    """The same by deeptime."""
    try:
        from deeptime.markov import TransitionCountEstimator
    except ModuleNotFoundError:
        raise SystemExit("deeptime is not installed: `sh envs/setup.sh checks` installs it") from None

    def run() -> sparse.csr_array:
        paths = list(np.ascontiguousarray(np.asarray(cells).T))
        estimator = TransitionCountEstimator(1, "sliding", n_states=grid.n_cells, sparse=True)
        counts = estimator.fit(paths).fetch_model().count_matrix.tocsr()
        sums = np.asarray(counts.sum(axis=1)).ravel()
        return sparse.csr_array(sparse.diags_array(1.0 / np.where(sums > 0, sums, 1.0)) @ counts)

    return run


def dynamic_matrix(cells: np.ndarray, grid: Grid) -> Callable[[], sparse.csr_array]:
    """Counts and matrix of the dynamic chain."""

    def run() -> sparse.csr_array:
        single, double = count_moves(cells, grid.n_cells), count_pairs(cells, grid.n_cells)
        return dynamic.from_counts(double, single, grid, INTERVAL_S).matrix

    return run


def static_counts(cells: np.ndarray, grid: Grid) -> Callable[[], sparse.csr_array]:
    """Counts alone."""
    return lambda: count_moves(cells, grid.n_cells).moves


def placed(places: np.ndarray, grid: Grid) -> Frames:
    """Frames of positions, (n_frames, 2, n_particles); velocities are their differences."""
    x, z = (np.ascontiguousarray(places[:, row]) for row in (0, 1))
    return Frames(np.arange(len(places), dtype=np.float64) * INTERVAL_S, x, z, grid.cell_of(x, z))


def _run_model(name: str, what: str) -> Callable[[np.ndarray, Grid], Callable[[], Any]]:
    def prepare(places: np.ndarray, grid: Grid) -> Callable[[], Any]:
        steps, frames = len(places) - 1, placed(places, grid)
        if what == "learn":
            return lambda: registry.learn(name, frames, grid)
        chain, start = registry.learn(name, frames, grid), frames.part(slice(0, 3))
        if what == "curves":
            return lambda: chain.mixing(start, 0.135, 0.25, steps)
        return lambda: sum(cells for cells in chain.paths(start, steps, np.random.default_rng(SEED)))

    return prepare


def _run_chain(learn: Any, what: str) -> Callable[[np.ndarray, Grid], Callable[[], Any]]:
    def prepare(cells: np.ndarray, grid: Grid) -> Callable[[], Any]:
        steps = len(cells) - 1
        start = frames_of(np.asarray(cells[:3]), grid)
        chain = learn(Frames(np.arange(len(cells), dtype=np.float64) * INTERVAL_S, cells, cells, cells), grid)
        if what == "curves":
            return lambda: chain.mixing(start, 0.135, 0.25, steps)
        states = chain.states(start)
        return lambda: propagate.simulate(chain.matrix, states, steps, np.random.default_rng(SEED))

    return prepare


METHODS: dict[str, Callable[[np.ndarray, Grid], Callable[[], Any]]] = {
    "bedchain": static_matrix,
    "scipy coo": scipy_matrix,
    "deeptime": deeptime_matrix,
    "dynamic": dynamic_matrix,
    "counts": static_counts,
    "static curves": _run_chain(static.learn, "curves"),
    "static Monte Carlo": _run_chain(static.learn, "paths"),
    "dynamic curves": _run_chain(dynamic.learn, "curves"),
    "dynamic Monte Carlo": _run_chain(dynamic.learn, "paths"),
    **{f"{name} {what}": _run_model(name, what) for name in PLACED for what in ("learn", "curves", "paths")},
}


def measure(method: str, path: Path, cells: tuple[int, int], repeats: int) -> dict[str, float]:
    """Run one method in this process: once on a few frames to compile, then timed.

    Returns
    -------
    dict
        Median time and processor time [s], peak memory of the process and what of it came with the method
        [MB], and the number of entries of what was made.
    """
    array, grid = np.load(path, mmap_mode="r"), grid_of(cells)
    METHODS[method](np.array(array[:24, ..., :1000]), grid)()
    before = peak_memory_mb()
    run = METHODS[method](array, grid)
    times, busy = [], []
    for _ in range(repeats):
        began, worked = time.perf_counter(), time.process_time()
        result = run()
        times.append(time.perf_counter() - began)
        busy.append(time.process_time() - worked)
    stored = result.arrays().values() if hasattr(result, "arrays") else [result]
    entries = sum(int(part.nnz if sparse.issparse(part) else part.size) for part in stored)
    return {
        "median_s": statistics.median(times),
        "cpu_s": statistics.median(busy),
        "peak_rss_mb": peak_memory_mb(),
        "own_rss_mb": peak_memory_mb() - before,
        "entries": entries,
    }


def tasks(quick: bool) -> list[Task]:
    """Lines of the table, with the targets where there are any."""
    n, steps = (8_100, 50) if quick else (81_000, 200)
    repeats = 3 if quick else 5
    matrix, run = "static counts and matrix", f"{steps} steps of {n} particles"
    large = [(100_000, 1), (1_000_000, 1)] if quick else [(1_000_000, 1), (10_000_000, 1)]
    return [
        Task(matrix, "bedchain", n, steps, PAPER_CELLS, repeats, 0.3),
        Task(matrix, "scipy coo", n, steps, PAPER_CELLS, repeats),
        Task(matrix, "deeptime", n, steps, PAPER_CELLS, 1 if quick else 3),
        Task("dynamic counts and matrix", "dynamic", n, steps, PAPER_CELLS, repeats, limit_mb=500),
        Task("exact mixing curves", "static curves", n, steps, PAPER_CELLS, repeats, 0.02),
        Task("exact mixing curves", "dynamic curves", n, steps, PAPER_CELLS, repeats),
        Task(f"Monte Carlo, {run}", "static Monte Carlo", n, steps, PAPER_CELLS, repeats, 1.0),
        Task(f"Monte Carlo, {run}", "dynamic Monte Carlo", n, steps, PAPER_CELLS, repeats),
        Task("static counts, one cell a diameter", "counts", n, steps, FINE_CELLS, repeats),
        *(Task("learning", f"{name} learn", n, steps, PAPER_CELLS, 1, limit_mb=1000) for name in PLACED),
        *(Task("mixing curves", f"{name} curves", n, steps, PAPER_CELLS, 1) for name in PLACED),
        *(Task(f"Monte Carlo, {run}", f"{name} paths", n, steps, PAPER_CELLS, repeats) for name in PLACED),
        *(
            Task("static counts from disk", "counts", m, steps, PAPER_CELLS, r, limit_mb=2000)
            for m, r in large
        ),
    ]


def run_task(task: Task, folder: Path) -> dict[str, Any]:
    """Measure a task in a fresh process, on a trajectory that is made if need be and deleted when large."""
    columns, rows = task.cells
    places = task.method.split()[0] in PLACED
    path = folder / f"{'places' if places else 'cells'}_{task.particles}_{columns}x{rows}.npy"
    if not path.exists():
        frames = task.steps + 1
        synthetic.write_cells(path, grid_of(task.cells), task.particles, frames, SEED, INTERVAL_S, places)
        os.sync()  # or writing it to disk is timed as reading it
    command = [sys.executable, __file__, "--method", task.method, "--cells", f"{columns}x{rows}"]
    command += ["--trajectory", str(path), "--repeats", str(task.repeats)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"benchmark of {task.method} failed:\n{done.stderr}")
    if task.particles > 500_000:
        path.unlink()
    found = json.loads(done.stdout.splitlines()[-1])
    limits = [("s", task.limit_s, found["median_s"]), ("MB", task.limit_mb, found["peak_rss_mb"])]
    targets = [(unit, limit, value) for unit, limit, value in limits if limit < float("inf")]
    row = {"work": task.work, "method": task.method, "particles": task.particles, "steps": task.steps}
    row |= {"columns": columns, "rows": rows, "repeats": task.repeats} | found
    row["target"] = " and ".join(f"<= {limit:g} {unit}" for unit, limit, _ in targets)
    row["met"] = "" if not targets else "yes" if all(value <= limit for _, limit, value in targets) else "no"
    return row


def main() -> None:
    """Measure everything, or one method (as each fresh process does)."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--quick", action="store_true", help="a tenth of the particles: seconds, to try it out"
    )
    parser.add_argument(
        "--output", type=Path, default=Path("results/benchmark_core.csv"), help="csv to write"
    )
    parser.add_argument("--folder", type=Path, help="where the synthetic trajectories go meanwhile (8 GB)")
    one = parser.add_argument_group("one method, as the command runs each in a fresh process")
    one.add_argument("--method", choices=METHODS, help="method to measure")
    one.add_argument("--trajectory", type=Path, help="cells, .npy of (frames, particles)")
    one.add_argument("--cells", help="grid, such as 27x105")
    one.add_argument("--repeats", type=int, default=3, help="times to run it")
    given = parser.parse_args()
    if given.method:
        columns, rows_ = (int(count) for count in given.cells.split("x"))
        print(json.dumps(measure(given.method, given.trajectory, (columns, rows_), given.repeats)))
        return
    rows = []
    with tempfile.TemporaryDirectory(dir=given.folder) as folder:
        for task in tasks(given.quick):
            print(f"{task.work}: {task.method}, {task.particles} particles ...", file=sys.stderr, flush=True)
            rows.append(run_task(task, Path(folder)))
    write_csv(pd.DataFrame(rows, columns=FIELDS), given.output)
    print(f"{machine()}; {rows[0]['steps']} steps; each line in a fresh process\n")
    print(table(rows) + "\n")
    print("\n".join(relative_rows(rows)))


if __name__ == "__main__":
    main()
