# SPDX-License-Identifier: GPL-3.0-or-later
"""Five beds of different shapes with all that figures are drawn of, and the figures.

``python tests/made/figure_beds.py OUT [BED ...]`` draws them to be looked at, and names their layout's flaws.
"""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2] / "scripts")]

from bedchain.comparison.curves import ChainFiles
from bedchain.figures.style import FigureFiles
from bedchain.files import write_csv
from bedchain.measures.batch import observed_shares
from bedchain.measures.mixing import Splits
from bedchain.measures.voidage import Slab
from bedchain.trajectory.cell_store import open_cells, write_cells
from bedchain.trajectory.frames import Window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import BedFiles, trajectory_metadata
from made.drawings import DPI, CheckedFiles
from made.synthetic_bed import rolling_bed, write_run, write_series
from plot_cells import plot_cells
from plot_chapman_kolmogorov import plot_chapman_kolmogorov
from plot_choice import plot_choice
from plot_cost import plot_cost
from plot_difference import plot_difference
from plot_discussion import plot_discussion
from plot_distribution import plot_distribution
from plot_mixing import plot_mixing
from plot_modes import plot_modes
from plot_snapshot import plot_snapshot
from plot_stationarity import plot_stationarity
from plot_timescales import plot_timescales

TIMES = np.round(np.arange(0, 3.001, 0.05), 6)
START, END, LAG = 1.5, 3.0, 0.05
MOMENTS = np.array([0.05, 0.30, 0.55, 0.80, 1.05, 1.30])
MODELS = ("static", "dynamic", "velocity_class")
COLOURS = {"dem": "#222222", "static": "#ee6677", "dynamic": "#4477aa", "velocity_class": "#228833"}
GROUPS = {"left": "radial", "right": "radial", "low": "axial", "up": "axial"}
LAGS = (0.05, 0.1, 0.2, 0.4, 0.8)


@dataclass(frozen=True)
class Shape:
    """Size of a bed, its filled height, its cells and particles."""

    width: float
    height: float
    filled: float
    columns: int
    rows: int
    number: int
    diameter: float
    thickness: float
    drum: bool = False


SHAPES = {
    "paper": Shape(0.27, 1.05, 0.6, 27, 105, 4000, 1e-3, 1e-3),
    "short": Shape(0.10, 0.40, 0.17, 10, 40, 2000, 1e-3, 1e-3),
    "narrow": Shape(0.012, 0.60, 0.35, 2, 100, 800, 1e-3, 1e-3),
    "drum": Shape(0.24, 0.24, 0.10, 12, 12, 1500, 3e-3, 3e-3, drum=True),
    "layers": Shape(0.044, 0.154, 0.06, 8, 28, 3000, 1.2e-3, 1e-2),
}


def figure_bed(folder: Path, shape: Shape) -> Path:
    """Write every file that the figures of a bed are drawn of; the bed moves in two rolls."""
    frames = rolling_bed(shape.number, shape.width, shape.filled, TIMES)
    dem = write_run(folder, frames[:2], TIMES[:2], shape.width, shape.height)
    manifest = json.loads(dem.read_text()) | {"gas": "gas.npz"}
    manifest["frames"] = [
        {"step": round(time / 2e-5), "time_s": float(time), "file": "none"} for time in TIMES
    ]
    dem.write_text(json.dumps(manifest))
    np.save(folder / "trajectory.npy", frames.astype(np.float32))
    described = trajectory_metadata(manifest, np.arange(1, shape.number + 1), shape.width, shape.height)
    (folder / "trajectory.json").write_text(json.dumps(described | {"frame_interval_s": 0.05}))
    grid = Grid(shape.width, shape.height, shape.columns, shape.rows)
    write_cells(np.load(folder / "trajectory.npy", mmap_mode="r"), TIMES, grid, folder / "cells.npz")
    write_series(folder, np.arange(0, 3.001, 0.01), 800.0, shape.filled / 2, shape.number)
    if shape.drum:
        series = pd.read_csv(folder / "bed_series.csv")
        series["surface_angle_rad"] = series.pop("pressure_drop_Pa") / 1600
        series.to_csv(folder / "bed_series.csv", index=False)
    write_gas(folder, shape)
    write_chains(folder, shape)
    write_tables(folder, shape)
    return folder


def write_gas(folder: Path, shape: Shape) -> None:
    """gas.npz with one bubble in the bed."""
    columns, rows = max(2, shape.columns // 2), max(4, shape.rows // 2)
    z, x = np.meshgrid(
        (np.arange(rows) + 0.5) / rows * shape.height, (np.arange(columns) + 0.5) / columns * shape.width,
        indexing="ij",
    )  # fmt: skip
    empty = (z > shape.filled) | (np.hypot(x - shape.width / 2, z - shape.filled / 2) < shape.filled / 5)
    voidage = np.where(empty, 1.0, 0.45).ravel()
    arrays = {"x_m": x.ravel(), "z_m": z.ravel(), "voidage": voidage[None], "times_s": np.array([START])}
    np.savez(folder / "gas.npz", **arrays)


def write_chains(folder: Path, shape: Shape) -> None:
    """chain_<model>.npz: a batch that spreads as the DEM's does, smeared, and curves with their bands."""
    store, times = open_cells(folder / "cells.npz"), TIMES[TIMES >= START - 1e-9]
    dem = observed_shares(store, MOMENTS, START, shape.filled / 5)
    for place, model in enumerate(MODELS):
        smeared = dem.reshape(-1, shape.rows, shape.columns)
        for _ in range(2 + 2 * place):
            smeared = (smeared + np.roll(smeared, 1, 1) + np.roll(smeared, -1, 1)) / 3
        curves = np.column_stack([curve(group, 0.4 + 0.2 * place, times) for group in GROUPS])
        spread = (
            np.random.default_rng(place).normal(0, 0.01, (5, 1, 4)) * (1 - np.exp(START - times))[:, None]
        )
        np.savez(
            folder / f"chain_{model}.npz", model=model, moments_s=MOMENTS, times_s=times, groups=list(GROUPS),
            batch_share=smeared.reshape(len(MOMENTS), -1),
            remaining=curves, remaining_left_out=curves + spread, batch_share_left_out=smeared[:0],
        )  # fmt: skip


def curve(
    group: str, tau_s: float, times_s: np.ndarray, swing: float = 0.0, phase: float = 0.0
) -> np.ndarray:
    """Share still on its side [1]: it falls to that of a mixture, and bubbles swing it."""
    mixed, since = {"low": 0.65, "up": 0.35}.get(group, 0.5), times_s - START
    return (
        mixed
        + (1 - mixed) * np.exp(-since / tau_s)
        + swing * np.sin(9 * since + phase) * (1 - np.exp(-4 * since))
    )


def write_tables(folder: Path, shape: Shape) -> None:
    """mixing.csv, metrics.csv, timing.csv, provenance.json, diagnostics.csv and discussion.csv."""
    times = TIMES[TIMES >= START - 1e-9]
    sources = {"dem": (0.5, 0.06, 0), "dem_1": (0.5, 0.06, 2), "dem_2": (0.6, 0.06, 4)}
    for place, model in enumerate(MODELS):
        sources |= {model: (0.4 + 0.2 * place, 0, 0), f"{model}_monte_carlo": (0.4 + 0.2 * place, 0.005, 0)}
    parts = [
        pd.DataFrame({"time_s": times, "source": source, "direction": direction, "group": group,
                      "fraction_remaining_1": curve(group, tau, times, swing, phase)})
        for source, (tau, swing, phase) in sources.items()
        for group, direction in GROUPS.items()
    ]  # fmt: skip
    write_csv(pd.concat(parts), folder / "mixing.csv")
    shares = {"left": 0.5, "right": 0.5, "low": 0.65, "up": 0.35}
    rows = [
        (f"share_{when}_{group}", "dem", share)
        for when in ("start", "mean")
        for group, share in shares.items()
    ]
    write_csv(pd.DataFrame(rows, columns=["quantity", "source", "value"]), folder / "metrics.csv")
    stages = {"dem": 2000.0}
    for place, model in enumerate(MODELS):
        costs = {"count": 0.3, "matrix": 0.01, "exact": 0.02, "monte_carlo": 0.7}
        stages |= {f"{model}_{stage}": seconds * 4**place for stage, seconds in costs.items()}
    write_csv(pd.DataFrame({"stage": stages.keys(), "wall_s": stages.values()}), folder / "timing.csv")
    (folder / "provenance.json").write_text('{"machine": {"processor": "AMD EPYC"}}')
    write_csv(pd.DataFrame(diagnostics_rows()), folder / "diagnostics.csv")
    write_csv(pd.DataFrame(discussion_rows(own_cell(shape))), folder / "discussion.csv")
    write_csv(pd.DataFrame(choice_rows(), columns=["quantity", "value"]), folder / "choice.csv")
    write_csv(pd.DataFrame(choice_curve()), folder / "choice_curve.csv")
    write_csv(modes_table(shape), folder / "modes.csv")


def own_cell(shape: Shape) -> float:
    """Side of a square as large as a cell [m]."""
    return float(np.sqrt(shape.width * shape.height / shape.columns / shape.rows))


def diagnostics_rows() -> list[dict]:
    """Curves and timescales; the dynamic chain lacks the longest lags, and bands, the third is unbanded."""
    rows, times = [], np.arange(1, 31) * LAG
    for group in GROUPS:
        share = curve(group, 0.5, START + times)
        for time, value in zip(times, share, strict=True):
            rows.append({"quantity": "remaining_counted", "source": "dem", "time_s": time, "part": group,
                         "value": value, "ci_low": value - 0.03, "ci_high": value + 0.03})  # fmt: skip
    for model in MODELS:
        for lag in LAGS[: 3 if model == "dynamic" else 5]:
            known = {"source": model, "lag_s": lag}
            for group in GROUPS:
                at = np.arange(1, int(1.5 / lag) + 1) * lag
                values = curve(group, 0.5 + 0.02 / lag, START + at)
                curves = known | {"quantity": "remaining_propagated", "part": group}
                rows += [
                    curves | {"time_s": time, "value": value} for time, value in zip(at, values, strict=True)
                ]
            for part, scale in enumerate((1.2, 0.9, 0.9, 0.4), 1):
                value = scale * (1 + 0.05 / lag)
                ends = {} if model == "dynamic" else {"ci_low": 0.7 * value, "ci_high": 1.3 * value}
                rows.append(known | {"quantity": "implied_timescale", "part": part, "value": value} | ends)
    return rows


def discussion_rows(own_cell_m: float) -> list[dict]:
    """Errors with intervals, and dispersion that grows with the cells."""
    rows = [{"quantity": "realisations", "source": "dem", "value": 3}]
    for size in own_cell_m * np.array([0.5, 1.0, 1.5, 3.0, 5.0]):
        for lag in LAGS:
            known = {"cell_m": size, "lag_s": lag}
            added = (size / own_cell_m) ** 2 / lag
            for quantity, value in (
                ("dispersion", 20.0),
                ("dispersion_of_cells", 20 + added),
                ("dispersion_added", 1.2 * added),
            ):
                rows.append(
                    known | {"quantity": quantity, "source": "dem", "part": "x", "value": 1e-4 * value}
                )
            for place, model in enumerate(MODELS):
                for direction in ("radial", "axial"):
                    error = (0.1 - 0.06 * place) * (LAG / lag) ** 0.5 * (0.2 if direction == "axial" else 1)
                    ends = {"value": error, "ci_low": error - 0.02, "ci_high": error + 0.02}
                    rows.append(
                        known | {"quantity": "error_signed", "source": model, "part": direction} | ends
                    )
    return rows


def choice_rows() -> list[tuple[str, float]]:
    """A lag of 0.2 s and cells of 3 cm."""
    lags = [("lag_s", 0.2), ("lag_low_s", 0.15), ("lag_high_s", 0.3)]
    return [*lags, ("cell_m", 0.03), ("columns", 9), ("rows", 35)]


def choice_curve() -> list[dict]:
    """Dispersion that rises and falls over the lag, and what cells add to it."""
    rows = []
    for axis, scale in (("x", 1e-3), ("z", 5e-3)):
        for lag in 0.05 * np.arange(1, 16):
            value = scale * lag / 0.2 * np.exp(1 - lag / 0.2)
            rows.append({"quantity": "dispersion", "axis": axis, "lag_s": lag, "value": value,
                         "ci_low": 0.8 * value, "ci_high": 1.25 * value})  # fmt: skip
        for size in (0.003, 0.01, 0.03, 0.06):
            rows.append(
                {"quantity": "added_share", "axis": axis, "cell_m": size, "value": 0.03 * size / scale / 30}
            )
    return rows


def modes_table(shape: Shape) -> pd.DataFrame:
    """Two processes, side by side and one above the other, and a roll, for two chains."""
    grid = Grid(shape.width, shape.height, shape.columns, shape.rows)
    x, z = grid.centres_m[:, 0] / shape.width, grid.centres_m[:, 1] / shape.filled
    held = np.where(z < 1, 1.0, 0.0)
    density = held / held.sum()
    values = {
        ("excess", 1): np.sin(np.pi * (x - 0.5)) * held,
        ("excess", 2): np.cos(np.pi * z) * held,
        ("timescale", 1): np.full(len(x), 0.8),
        ("timescale", 2): np.full(len(x), 0.6),
        ("density", None): density,
        ("flow_x", None): 0.3 * density * np.cos(np.pi * z) * np.sin(2 * np.pi * x),
        ("flow_z", None): -0.3 * density * np.sin(np.pi * z) * np.cos(2 * np.pi * x),
    }
    return pd.concat(
        pd.DataFrame({"source": source, "quantity": quantity, "part": part, "cell": np.arange(len(x)),
                      "x_m": x, "z_m": z, "value": of_cells})
        for source in MODELS[:2]
        for (quantity, part), of_cells in values.items()
    )  # fmt: skip


def drawings(folder: Path, shape: Shape, out: Path, kind: type[FigureFiles] = CheckedFiles) -> dict:
    """A function for each figure of the bed, by its name, that saves it as files of a kind."""
    bed = BedFiles(*(folder / name for name in ("trajectory.npy", "trajectory.json", "cells.npz")))
    splits = Splits(shape.width / 2, shape.filled / 2)
    chain = {model: folder / f"chain_{model}.npz" for model in MODELS}

    def files(name: str) -> FigureFiles:
        return kind(*(out / f"{name}.{form}" for form in ("png", "pdf", "csv")), DPI)

    def mixing(name: str, direction: str) -> None:
        chains = ChainFiles(list(MODELS), list(chain.values()))
        plot_mixing(folder / "mixing.csv", folder / "metrics.csv", chains, files(name), direction, COLOURS)

    def batch(name: str, model: str) -> None:
        plot_distribution(bed.cells, chain[model], files(name), model, START, shape.filled / 5, "YlGnBu")

    cost = (folder / "timing.csv", folder / "dem.json", [folder / "provenance.json"])
    of_chains = {model: COLOURS[model] for model in MODELS}
    diagnostics, window = folder / "diagnostics.csv", Window(0.5, END)
    row_m, slab = shape.height / shape.rows, Slab(shape.thickness, shape.diameter)
    figures = {
        "fig1_cells": lambda name: plot_cells(bed, files(name), START, shape.diameter, "#9aa5b1"),
        "fig2_cost": lambda name: plot_cost(*cost, files(name), "#4477aa", END - START),
        "fig3_static": lambda name: batch(name, "static"),
        "fig_distribution_velocity_class": lambda name: batch(name, "velocity_class"),
        "fig5a_radial": lambda name: mixing(name, "radial"),
        "fig5b_axial": lambda name: mixing(name, "axial"),
        "fig_difference": lambda name: plot_difference(
            bed.cells, chain["static"], chain["dynamic"], files(name), START
        ),
        "fig_chapman_kolmogorov": lambda name: plot_chapman_kolmogorov(diagnostics, files(name), COLOURS),
        "fig_timescales": lambda name: plot_timescales(diagnostics, files(name), of_chains),
        "fig_stationarity": lambda name: plot_stationarity(
            folder / "bed_series.csv", bed, out / "stationarity.csv", files(name), window, splits, row_m, slab
        ),
        "fig_discussion": lambda name: plot_discussion(
            folder / "discussion.csv", files(name), own_cell(shape), LAG, of_chains
        ),
    }
    choice = (folder / "choice.csv", folder / "choice_curve.csv")
    figures["fig_choice"] = lambda name: plot_choice(*choice, files(name))
    figures["fig_modes"] = lambda name: plot_modes(folder / "modes.csv", bed.cells, files(name))
    if not shape.drum:
        figures["snapshot"] = lambda name: plot_snapshot(
            folder / "dem.json", bed, files(name), START, shape.diameter, "coolwarm"
        )
    return figures


if __name__ == "__main__":
    OUT, *places = sys.argv[1:]
    for place in places or SHAPES:
        target = Path(OUT) / place
        (target / "data").mkdir(parents=True, exist_ok=True)
        made = figure_bed(target / "data", SHAPES[place])
        for name, draw in drawings(made, SHAPES[place], target).items():
            try:
                draw(name)
            except AssertionError as flaws:
                print(f"{place} {name}: {flaws}", flush=True)
