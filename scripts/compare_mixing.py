# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing by the DEM and by the chains, and how they differ: results/<case>/mixing.csv and metrics.csv."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.array_files import read_arrays
from bedchain.comparison.curves import ChainFiles, curve_table, curves_of
from bedchain.comparison.metrics import (
    batch_metrics,
    bed_metrics,
    dem_metrics,
    floor_metrics,
    metric,
    model_metrics,
    noise_metrics,
    report_metrics,
)
from bedchain.dem.series import read_series
from bedchain.errors import UserError, make_again
from bedchain.files import write_csv
from bedchain.measures.batch import observed_shares
from bedchain.measures.mixing import Splits, remaining_from_positions, sides
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles


@dataclass(frozen=True)
class SolverSeries:
    """The bed as a whole, as the solver followed it.

    Attributes
    ----------
    bed_series : Path
        ``bed_series.csv``.
    averaged : Window
        From the start of the learning to the end of the comparison.
    weight_Pa : float
        Weight of the particles over the bed's cross section [Pa].
    """

    bed_series: Path
    averaged: Window
    weight_Pa: float  # noqa: N815


@dataclass(frozen=True)
class Tables:
    """Tables to make.

    Attributes
    ----------
    mixing, metrics : Path
        ``mixing.csv`` and ``metrics.csv``.
    """

    mixing: Path
    metrics: Path


def compare_mixing(
    bed: BedFiles, chains: ChainFiles, solver: SolverSeries, repeats: list[Path], tables: Tables,
    comparison: Window, splits: Splits, batch_height_m: float,
) -> None:  # fmt: skip
    """Put the curves of the DEM and of all chains in one table, and their differences in another.

    Parameters
    ----------
    bed : BedFiles
    chains : ChainFiles
    solver : SolverSeries
    repeats : list of Path
        ``mixing.csv`` of each repeat of the DEM, in order of their numbers.
    tables : Tables
    comparison : Window
    splits : Splits
    batch_height_m : float
        Height of the batch of Figs. 3 and 4 [m].
    """
    run = open_bed(bed)
    frames = run.window(comparison)
    dem = remaining_from_positions(frames.x_m, frames.z_m, *splits)
    places = zip(frames.x_m, frames.z_m, strict=True)
    on_side = np.array([sides(x, z, *splits).mean(axis=1) for x, z in places])
    curves = [curve_table(frames.times_s, "dem", dem)]
    rows = bed_metrics(read_series(solver.bed_series), solver.weight_Pa, *solver.averaged)
    rows += [metric("particles", "dem", frames.cells.shape[1])]
    rows += dem_metrics(on_side, dem)
    curves += [pd.read_csv(path) for path in repeats]
    further = [curves_of(table, f"dem_{at}", len(dem)) for at, table in enumerate(curves[1:], 1)]
    realisations = np.stack([dem, *further])
    if further:
        rows += floor_metrics(realisations)
    for model, path in chains.by_model().items():
        chain = read_arrays(path)
        observed = observed_shares(run.case_cells, chain["moments_s"], comparison.start_s, batch_height_m)
        if len(chain["times_s"]) != len(dem):
            start_s, end_s = comparison
            raise UserError(
                f"{path} covers another window than {start_s:g} to {end_s:g} s; {make_again(path)}"
            )
        left_out = (chain["remaining_left_out"], chain["batch_share_left_out"])
        for source, how, (curves_without, shares_without) in (
            (model, "", left_out),
            (f"{model}_monte_carlo", "_monte_carlo", (None, None)),
        ):
            remaining, share = chain[f"remaining{how}"], chain[f"batch_share{how}"]
            curves.append(curve_table(chain["times_s"], source, remaining))
            rows += model_metrics(source, remaining, dem, curves_without)
            if further:
                rows += noise_metrics(source, remaining, realisations)
            rows += batch_metrics(source, chain["moments_s"], share, observed, shares_without)
        rows += report_metrics(model, str(chain["report"]))
    table = pd.DataFrame(rows)
    write_csv(pd.concat(curves, ignore_index=True), tables.mixing)
    write_csv(table, tables.metrics)
    for row in table[table["quantity"].str.startswith(("error_rms", "pressure_drop_over"))].itertuples():
        LOG.info("%s, %s: %.4g", row.source, row.quantity, row.value)


if rule := globals().get("snakemake"):
    run_stage(compare_mixing, rule)
