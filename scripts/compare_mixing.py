# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing by the DEM and by the chains, and how they differ: results/<case>/mixing.csv and metrics.csv."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.comparison.curves import curve_table, curves_of
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
from bedchain.errors import UserError
from bedchain.files import read_arrays, write_csv
from bedchain.measures.batch import observed_shares
from bedchain.measures.mixing import remaining_from_positions, sides
from bedchain.stage import LOG, stage
from bedchain.trajectory.frames import lag_frames
from bedchain.trajectory.realisations import open_realisation


def compare_mixing(
    trajectory: Path, metadata: Path, cells: Path, chains: dict[str, Path], bed_series: Path,
    mixing: Path, metrics: Path,
    start_s: float, end_s: float, split_x_m: float, split_z_m: float, batch_height_m: float,
    bed_start_s: float, bed_end_s: float, weight_Pa: float, repeats: Sequence[Path] = (),
) -> None:  # fmt: skip
    """Put the curves of the DEM and of all chains in one table, and their differences in another.

    Parameters
    ----------
    trajectory, metadata, cells : Path
        ``trajectory.npy``, ``trajectory.json``, ``cells.npz``.
    chains : dict of str to Path
        ``chain_<model>.npz`` by model.
    bed_series : Path
        ``bed_series.csv`` of the solver.
    mixing, metrics : Path
        Tables to make.
    start_s, end_s : float
        The comparison window [s].
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    batch_height_m : float
        Height of the batch of Figs. 3 and 4 [m].
    bed_start_s, bed_end_s : float
        Start of the learning and end of the comparison window, between which the bed is averaged [s].
    weight_Pa : float
        Weight of the particles over the bed's cross section [Pa].
    repeats : sequence of Path
        ``mixing.csv`` of each repeat of the DEM, in order of their numbers.
    """
    bed = open_realisation("the run", trajectory, metadata, cells)
    frames = bed.window(start_s, end_s)
    dem = remaining_from_positions(frames.x_m, frames.z_m, split_x_m, split_z_m)
    places = zip(frames.x_m, frames.z_m, strict=True)
    on_side = np.array([sides(x, z, split_x_m, split_z_m).mean(axis=1) for x, z in places])
    curves = [curve_table(frames.times_s, "dem", dem)]
    rows = bed_metrics(read_series(bed_series), weight_Pa, bed_start_s, bed_end_s)
    rows += [metric("particles", "dem", frames.cells.shape[1])]
    rows += dem_metrics(on_side, dem)
    curves += [pd.read_csv(path) for path in repeats]
    further = [curves_of(table, f"dem_{at}", len(dem)) for at, table in enumerate(curves[1:], 1)]
    realisations = np.stack([dem, *further])
    if further:
        rows += floor_metrics(realisations)
    for model, path in chains.items():
        chain = read_arrays(path)
        observed = observed_shares(bed.stored, chain["moments_s"], start_s, batch_height_m)
        lag = lag_frames(float(chain["lag_s"]), frames.interval_s)
        if len(chain["times_s"]) != len(dem[::lag]):
            raise UserError(f"{path} covers another window than {start_s:g} to {end_s:g} s: delete it")
        for source, how, replicates in (
            (model, "", chain["remaining_replicates"]),
            (f"{model}_monte_carlo", "_monte_carlo", None),
        ):
            remaining, share = chain[f"remaining{how}"], chain[f"batch_share{how}"]
            curves.append(curve_table(chain["times_s"], source, remaining))
            rows += model_metrics(source, remaining, dem[::lag], replicates)
            if further:
                rows += noise_metrics(source, remaining, realisations[:, ::lag])
            rows += batch_metrics(source, chain["moments_s"], share, observed)
        rows += report_metrics(model, str(chain["report"]))
    table = pd.DataFrame(rows)
    write_csv(pd.concat(curves, ignore_index=True), mixing)
    write_csv(table, metrics)
    for row in table[table["quantity"].str.startswith(("error_rms", "pressure_drop_over"))].itertuples():
        LOG.info("%s, %s: %.4g", row.source, row.quantity, row.value)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        compare_mixing(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.cells),
            dict(zip(snakemake.params.models, map(Path, snakemake.input.chains), strict=True)),
            Path(snakemake.input.bed_series),
            Path(snakemake.output.mixing),
            Path(snakemake.output.metrics),
            snakemake.params.start_s,
            snakemake.params.end_s,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
            snakemake.params.batch_height_m,
            snakemake.params.bed_start_s,
            snakemake.params.bed_end_s,
            snakemake.params.weight_Pa,
            [Path(file) for file in snakemake.input.repeats],
        )
