# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 5: the share of each marked group that is still on its side, by the DEM and by the chains."""

import math
import re
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.array_files import read_arrays
from bedchain.comparison.curves import ChainFiles
from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import ModelStyle, label, model_styles
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import CSV_DIGITS, write_csv
from bedchain.stage import run_stage
from bedchain.uncertainty.bands import block_band

PANELS = {
    "radial": {"left": "left half", "right": "right half"},
    "axial": {"low": "lower part", "up": "upper part"},
}
MONTE_CARLO = "_monte_carlo"
REALISATION = r"dem(_\d+)?"
MARKS_PER_CURVE = 14
BAND_OPACITY = 0.2
RUNS_COLOUR, RUNS_EDGE = "#d4d4d4", "#9a9a9a"
MIXED_COLOUR = "#888888"
LEGEND_COLUMNS, MANY, LEGEND_ROW_IN = 4, 9, 0.16
# a key of a legend: what is drawn above it
Entries = dict[str, Any]


def plot_mixing(
    mixing: Path, metrics: Path, chains: ChainFiles, files: FigureFiles,
    direction: str, colours: dict[str, str]
) -> None:  # fmt: skip
    """Draw both groups of one direction: DEM, exact expectation and Monte Carlo of each chain.

    Parameters
    ----------
    mixing, metrics : Path
        ``mixing.csv`` and ``metrics.csv`` of compare_mixing.
    chains : ChainFiles
        For the error bars.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    direction : {"radial", "axial"}
        Left and right (Fig. 5a), or low and up (Fig. 5b).
    colours : dict of str to str
        Colours of ``dem`` and of models; those without one get that of `model_styles`.

    Raises
    ------
    UserError
        The direction has no curves.
    """
    table = pd.read_csv(mixing).query("direction == @direction")
    if table.empty:
        raise UserError(f"{mixing} has no curves of direction {direction!r}; {make_again(mixing)}")
    table = table.merge(bands(chains.by_model()), how="left", on=["time_s", "source", "group"])
    table = with_realisations(table)
    shares, mixed = (_shares(pd.read_csv(metrics), when) for when in ("start", "mean"))
    styles = {
        model: style._replace(colour=colours.get(model, style.colour))
        for model, style in model_styles(chains.models).items()
    }
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 3.0), sharex=True, sharey=True)
        for axes, (group, name) in zip(panels, PANELS[direction].items(), strict=True):
            entries = _draw_group(axes, table[table["group"] == group], colours["dem"], styles, mixed[group])
            axes.set_title(f"{name}: {100 * shares[group]:.0f} % of the particles at the start", loc="left")
            axes.set_xlabel("time [s]")
        panels[0].set_ylabel("share still on its side [1]")
        shown = table[["fraction_remaining_1", "band_low_1"]].min().min()
        lowest = min(shown, *(mixed[group] for group in PANELS[direction]))
        panels[0].set_ylim(max(0.0, lowest - 0.03), 1.03)
        panels[0].set_xlim(table["time_s"].min(), table["time_s"].max())
        rows = math.ceil(len(entries) / (LEGEND_COLUMNS if len(entries) <= MANY else LEGEND_COLUMNS - 1))
        columns = math.ceil(len(entries) / rows)
        figure.set_figheight(figure.get_figheight() + LEGEND_ROW_IN * max(0, rows - 2))
        figure.legend(
            list(entries.values()), list(entries), loc="outside upper center", ncols=columns,
            handlelength=2.6, columnspacing=1.4,
        )  # fmt: skip
        files.save(figure)
    write_csv(table, files.csv)


def bands(chains: dict[str, Path]) -> pd.DataFrame:
    """95 % bands of the chains' curves, from chains learned without each block of the learning window.

    Parameters
    ----------
    chains : dict of str to Path
        ``chain_<model>.npz`` by model.

    Returns
    -------
    DataFrame
        time_s, source, group, band_low_1, band_high_1; NaN where the learning window is too short for a band.
    """
    parts = []
    for model, path in chains.items():
        chain = read_arrays(path)
        low, high = block_band(chain["remaining"], chain["remaining_left_out"], "share")
        for column, group in enumerate(chain["groups"]):
            parts.append(
                pd.DataFrame(
                    {
                        # as written to and read from mixing.csv
                        "time_s": [float(CSV_DIGITS % time) for time in chain["times_s"]],
                        "source": model,
                        "group": str(group),
                        "band_low_1": low[:, column],
                        "band_high_1": high[:, column],
                    }
                )
            )
    return pd.concat(parts, ignore_index=True)


def with_realisations(table: pd.DataFrame) -> pd.DataFrame:
    """The table with the band of the DEM's curves, from the lowest to the highest of all realisations.

    Parameters
    ----------
    table : DataFrame
        time_s, source, group, fraction_remaining_1, band_low_1, band_high_1.

    Returns
    -------
    DataFrame
        The same, with bands in the rows of ``dem`` where there are repeats, ``dem_1``, ``dem_2``, ...
    """
    of_dem = table["source"].str.fullmatch(REALISATION)
    if table.loc[of_dem, "source"].nunique() < 2:
        return table
    ends = table[of_dem].groupby(["time_s", "group"])["fraction_remaining_1"].agg(["min", "max"])
    main = table["source"] == "dem"
    found = ends.loc[pd.MultiIndex.from_frame(table.loc[main, ["time_s", "group"]])]
    table.loc[main, ["band_low_1", "band_high_1"]] = found.to_numpy()
    return table


def _draw_group(
    axes: Axes, table: pd.DataFrame, dem_colour: str, styles: dict[str, ModelStyle], mixed: float
) -> Entries:
    """Draw one group; what its legend says, by label."""
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)
    curves = {str(source): rows.sort_values("time_s") for source, rows in table.groupby("source", sort=False)}
    entries = _draw_dem(axes, curves, dem_colour)
    for source, curve in curves.items():
        model = source.removesuffix(MONTE_CARLO)
        if model not in styles:
            continue
        style, time, share = styles[model], curve["time_s"], curve["fraction_remaining_1"]
        if source != model:
            every = max(1, len(curve) // MARKS_PER_CURVE)
            entries[f"{label(model)}, Monte Carlo"] = (
                *axes.plot(time, share, style.marker, markevery=every, ms=3.2, color=style.colour,
                           mfc="white", mew=0.9, clip_on=False),
            )  # fmt: skip
            continue
        line = axes.plot(time, share, color=style.colour, linestyle=style.dash)
        if curve["band_low_1"].notna().any():
            band_ends = curve["band_low_1"], curve["band_high_1"]
            area = axes.fill_between(time, *band_ends, color=style.colour, alpha=BAND_OPACITY, linewidth=0)
            entries[f"{label(model)}, 95 % band"] = (area, *line)
        else:
            entries[f"{label(model)}, no band: window too short"] = (*line,)
    line = [axes.axhline(mixed, color=MIXED_COLOUR, linewidth=0.8, linestyle=(0, (6, 2, 1, 2)))]
    return entries | {"well mixed": (*line,)}


def _draw_dem(axes: Axes, curves: dict[str, pd.DataFrame], colour: str) -> Entries:
    """The main run of the DEM above the range of all its runs."""
    dem = curves["dem"]
    entries: Entries = {}
    n_runs = sum(bool(re.fullmatch(REALISATION, source)) for source in curves)
    if n_runs > 1:
        area = axes.fill_between(
            dem["time_s"], dem["band_low_1"], dem["band_high_1"], facecolor=RUNS_COLOUR, edgecolor=RUNS_EDGE,
            linewidth=0.5, zorder=1,
        )  # fmt: skip
        entries[f"{n_runs} DEM runs, lowest to highest"] = (area,)
    line = axes.plot(dem["time_s"], dem["fraction_remaining_1"], color=colour, lw=1.6)
    return {"DEM, this run" if n_runs > 1 else "DEM": (*line,)} | entries


def _shares(metrics: pd.DataFrame, when: str) -> dict[str, float]:
    """Share of all particles on each side when they were marked, or on average."""
    rows = metrics[metrics["quantity"].str.startswith(f"share_{when}_") & (metrics["source"] == "dem")]
    return dict(zip(rows["quantity"].str.removeprefix(f"share_{when}_"), rows["value"], strict=True))


if rule := globals().get("snakemake"):
    run_stage(plot_mixing, rule)
