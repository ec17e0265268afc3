# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers of the ladder's models: learned chains, two-fluid runs, and what is written down."""

import time
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeVar

import numpy as np

from bedchain.case.parameters import weight_per_area
from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.networks.bubbling_wakes import Mechanisms, bubbling_wakes, remaining
from bedchain.measures.mixing import GROUPS
from bedchain.meter import forget_peak, peak_memory_mb
from bedchain.physics.bubbling_bed import BubblingBed, bubbling_bed
from bedchain.studies.ladder.answers import Answer, Array, Values, of_density
from bedchain.studies.ladder.stays import stay_in_lower_part, stay_starts
from bedchain.studies.two_fluid_summary import Summary, piece_of, pressure_record
from bedchain.trajectory.frames import lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.trajectory.regrid import regrid
from bedchain.uncertainty.deviations import SIDES

Result = TypeVar("Result")
ENOUGH_S = 0.2  # of processor time: shorter work is repeated


class Setting(NamedTuple):
    """A learned chain of the ladder: its name there, its model, cells and lag [s]."""

    name: str
    model: str
    grid: Grid
    lag_s: float
    options: dict[str, Any]


def timed(work: Callable[[], Result]) -> tuple[Result, float]:
    """A result, and the processor time of one run [s]; short work is repeated.

    The first run is not timed: it loads and compiles what the others have at hand.
    """
    work()
    start, runs = time.process_time(), 0
    while True:
        result = work()
        runs += 1
        if (spent := time.process_time() - start) > ENOUGH_S:
            return result, spent / runs


def of_chain(
    setting: Setting, run: Realisation, spans: tuple[slice, slice], case: Case, estimator: str, shown: Grid
) -> Answer:
    """Learn a chain from the learning window and run it over the comparison window.

    Parameters
    ----------
    setting : Setting
    run : Realisation
    spans : (slice, slice)
        Frames of learning and comparison.
    case : dict
    estimator : str
        How counts become probabilities.
    shown : Grid
        Cells of the case, for the density.
    """
    lag = lag_frames(setting.lag_s, run.interval_s)
    learning, comparison = spans
    frames = run.frames(setting.grid, learning)
    forget_peak()
    began = time.process_time()
    chain = registry.learn(setting.model, frames, setting.grid, lag, estimator, **setting.options)
    learning_s = time.process_time() - began
    start = run.leading_to(setting.grid, comparison.start, lag)
    steps = (comparison.stop - 1 - comparison.start) // lag
    lines = case["mixing"]
    curves, spent = timed(lambda: chain.mixing(start, lines["split_x_m"], lines["split_z_m"], steps))
    density = regrid(chain.long_run_density(start), setting.grid, shown)
    values = of_density(density, shown, case)
    values |= by_direction(curves) | {"stay_low": stay_of(chain, run, spans, lag, case)}
    cost_s, cells = spent / (steps * setting.lag_s), f"{setting.grid.columns} x {setting.grid.rows} cells"
    return Answer(
        setting.name, values, cost_s, learning_s, peak_memory_mb(), setting.lag_s, True,
        f"{cells}, lag {setting.lag_s:g} s",
    )  # fmt: skip


def stay_of(chain: Chain, run: Realisation, spans: tuple[slice, slice], lag: int, case: Case) -> float:
    """Stay in the lower part of a chain's particles, from the starts of the simulated bed [s].

    Its heights are those of the middles of cells.
    """
    heights_m, line_m = chain.grid.centres_m[:, 1], case["mixing"]["split_z_m"]
    starts, horizon = stay_starts(*spans)
    rng = np.random.default_rng(case["chain"]["seed"])
    stays = []
    for frame in starts[-2:]:
        paths = chain.paths(run.leading_to(chain.grid, frame, lag), -(-horizon // lag), rng)
        heights = (heights_m[cells] for cells in paths)
        stays.append(stay_in_lower_part(heights, lag * run.interval_s, line_m, horizon * run.interval_s))
    return float(np.mean(stays))


def of_two_fluid(summary: Summary, shown: Grid, case: Case) -> Iterable[Answer]:
    """A two-fluid run, and the chain of its mean flow, which has circulation and no bubbles."""
    record = summary.record
    size = case["bed"]["width_m"], case["bed"]["height_m"]
    grid = Grid(*size, *(round(length / record["cell_m"]) for length in size))
    values = of_density(regrid(summary.density["share_1"].to_numpy(), grid, shown), shown, case)
    window = summary.pressure["time_s"].between(*record["window_s"])
    values["pressure_drop"] = float(summary.pressure.loc[window, "pressure_drop_Pa"].mean())
    for name in ("bubble_diameter_m", "bubble_velocity_m_s"):
        values[name.rsplit("_m", 1)[0]] = record[name]
    spectrum = pressure_record(summary.pressure, tuple(record["window_s"]), piece_of(case))
    values["pressure_frequency"] = spectrum["pressure_frequency_Hz"]
    lag_s, name = (
        float(np.diff(summary.mixing["time_s"].iloc[:2])[0]),
        f"two-fluid, {1000 * record['cell_m']:g} mm",
    )
    ran = f"{record['window_s'][0]:g} to {record['window_s'][1]:g} s"
    cost = {"cost_s": record["cpu_s_per_s"], "memory_mb": record.get("memory_mb", np.nan), "lag_s": lag_s}
    yield Answer(name, values | curves_of(summary, "frames"), **cost, note=ran)
    mean = {
        "density": values["density"],
        "voidage": values["voidage"],
        "particle_height": values["particle_height"],
    }
    yield Answer(
        f"{name}, mean flow", mean | curves_of(summary, "mean_flow"), **cost,
        note="a chain of the mean flow; it costs the run",
    )  # fmt: skip


def curves_of(summary: Summary, source: str) -> dict[str, Array]:
    """Mixing curves of a summary as of `Answer.values`."""
    table = summary.mixing[summary.mixing["source"] == source]
    wide = table.pivot_table(index="time_s", columns="group", values="fraction_remaining_1")
    return by_direction(wide[[group for _, group in GROUPS]].to_numpy())


def by_direction(curves: Array) -> dict[str, Array]:
    """Mixing curves (n_times, 4) of `GROUPS` as of `Answer.values`."""
    return {f"mixing_{direction}": curves[:, SIDES[direction]] for direction in ("radial", "axial")}


def of_two_phase(case: Case, grid: Grid, window_s: float) -> Answer:
    """The bubbling two-phase model; `RegimeError` outside its range.

    Parameters
    ----------
    case : dict
    grid : Grid
        Its rows are those of the voidage.
    window_s : float
        Time that its cost is spread over, as if it were simulated [s].
    """
    bed, spent = timed(lambda: bubbling_bed(scene_of(case)))
    half = len(bed.height) // 2
    values: Values = {
        "particle_height": bed.mean_height,
        "pressure_drop": weight_per_area(case),
        "voidage": voidage_of_rows(bed, grid, case),
        "bubble_diameter": float(bed.bubble_diameter[half]),
        "bubble_velocity": float(bed.bubble_velocity[half]),
    }
    return Answer("two-phase", values, spent / window_s, note=f"{bed.regime} bubbles, nothing fitted")


def voidage_of_rows(bed: BubblingBed, grid: Grid, case: Case) -> Array:
    """Voidage of the rows of a grid, by the share of the particles below each of their edges [1]."""
    below = np.array([bed.share_below(edge) for edge in grid.z_edges_m])
    share = np.repeat(np.diff(below) / grid.columns, grid.columns)
    return np.asarray(of_density(share, grid, case)["voidage"])


def of_wakes(case: Case, grid: Grid, window_s: float, interval_s: float) -> Answer:
    """The axial chain with wakes and dispersion by the two-phase model; arguments as of `of_two_phase`.

    Its cells are as high as those of the case; `interval_s` is the time between points of its curves [s].
    """
    times = np.asarray(interval_s * np.arange(round(window_s / interval_s) + 1), dtype=np.float64)

    def curves() -> Array:
        bed = bubbling_bed(scene_of(case))
        cells = max(round(bed.bed_height / grid.cell_height_m), 2)
        network = bubbling_wakes(bed, cells, Mechanisms(wakes=True, dispersed=True))
        return remaining(network, case["mixing"]["split_z_m"], times)

    axial, spent = timed(curves)
    return Answer(
        "axial wakes", {"mixing_axial": axial}, spent / window_s, lag_s=interval_s, paths=True,
        note="wakes and dispersion by the two-phase model, nothing fitted",
    )  # fmt: skip


def plug_flow(window_s: float, interval_s: float) -> Answer:
    """Plug flow of the particles in a closed bed: none passes another, and none crosses a line."""
    count = round(window_s / interval_s) + 1
    curves, spent = timed(lambda: np.ones((count, 2)))
    return Answer("plug flow", {"mixing_axial": curves}, spent / window_s, lag_s=interval_s)
