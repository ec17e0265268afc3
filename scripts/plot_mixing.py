# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 5: the share of each marked group that is still on its side, by the DEM and by the chains."""

import re
from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from bedchain.comparison.curves import ChainFiles
from bedchain.errors import UserError, make_again
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import CSV_DIGITS, read_arrays, write_csv
from bedchain.stage import run_stage
from bedchain.uncertainty.bands import band

PANELS = {
    "radial": {"left": "left half", "right": "right half"},
    "axial": {"low": "lower part", "up": "upper part"},
}
MONTE_CARLO = "_monte_carlo"
REALISATION = r"dem(_\d+)?"
DASHES = {"static": (0, (4, 1.5)), "dynamic": (0, (1.2, 1.2))}
MARKERS = {"static": "o", "dynamic": "^"}
MARKS_PER_CURVE = 14
BAND_OPACITY = 0.2
MIXED_COLOUR = "#888888"


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
        Colours of ``dem`` and of each model.

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
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.8), sharex=True, sharey=True)
        for axes, (group, name) in zip(panels, PANELS[direction].items(), strict=True):
            _draw_group(axes, table[table["group"] == group], colours, mixed[group])
            axes.set_title(f"{name}: {100 * shares[group]:.0f} % of the particles at the start", loc="left")
            axes.set_xlabel("time [s]")
        panels[0].set_ylabel("share still on its side [1]")
        lowest = min(table["fraction_remaining_1"].min(), *(mixed[group] for group in PANELS[direction]))
        panels[0].set_ylim(max(0.0, lowest - 0.06), 1.03)
        panels[0].set_xlim(table["time_s"].min(), table["time_s"].max())
        handles, labels = panels[0].get_legend_handles_labels()
        handles.append(Patch(color=colours[chains.models[0]], alpha=BAND_OPACITY, linewidth=0))
        labels.append("95 % band of the chain")
        figure.legend(handles, labels, loc="outside upper center", ncols=4, handlelength=2.4)
        files.save(figure)
    write_csv(table, files.csv)


def bands(chains: dict[str, Path]) -> pd.DataFrame:
    """Bands that hold 95 % of the curves of chains learned again on blocks of the learning window.

    Parameters
    ----------
    chains : dict of str to Path
        ``chain_<model>.npz`` by model.

    Returns
    -------
    DataFrame
        time_s, source, group, band_low_1, band_high_1.
    """
    parts = []
    for model, path in chains.items():
        chain = read_arrays(path)
        low, high = band(chain["remaining_replicates"])
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


def _draw_group(axes: Axes, table: pd.DataFrame, colours: dict[str, str], mixed: float) -> None:
    axes.axhline(mixed, color=MIXED_COLOUR, linewidth=0.8, linestyle=(0, (6, 2, 1, 2)), label="well mixed")
    repeats = {name for name in table["source"] if re.fullmatch(REALISATION, name)} - {"dem"}
    for source, curve in table.groupby("source", sort=False):
        model = str(source).removesuffix(MONTE_CARLO)
        if source == "dem":
            if curve["band_low_1"].notna().all():
                label = f"DEM, lowest to highest of {len(repeats) + 1} runs"
                axes.fill_between(
                    curve["time_s"], curve["band_low_1"], curve["band_high_1"], color=colours["dem"],
                    alpha=BAND_OPACITY, linewidth=0, label=label,
                )  # fmt: skip
            axes.plot(
                curve["time_s"], curve["fraction_remaining_1"], color=colours["dem"], lw=1.6, label="DEM"
            )
        elif model in repeats:
            continue
        elif str(source).endswith(MONTE_CARLO):
            every = max(1, len(curve) // MARKS_PER_CURVE)
            axes.plot(
                curve["time_s"], curve["fraction_remaining_1"], MARKERS.get(model, "o"),
                markevery=every, ms=3.2,
                color=colours[model], mfc="white", mew=0.9, label=f"{model}, Monte Carlo", clip_on=False,
            )  # fmt: skip
        else:
            axes.fill_between(
                curve["time_s"], curve["band_low_1"], curve["band_high_1"], color=colours[model],
                alpha=BAND_OPACITY, linewidth=0,
            )  # fmt: skip
            axes.plot(
                curve["time_s"], curve["fraction_remaining_1"], color=colours[model],
                linestyle=DASHES.get(model, "--"), label=f"{model} chain",
            )  # fmt: skip
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


def _shares(metrics: pd.DataFrame, when: str) -> dict[str, float]:
    """Share of all particles on each side when they were marked, or on average."""
    rows = metrics[metrics["quantity"].str.startswith(f"share_{when}_") & (metrics["source"] == "dem")]
    return dict(zip(rows["quantity"].str.removeprefix(f"share_{when}_"), rows["value"], strict=True))


if rule := globals().get("snakemake"):
    run_stage(plot_mixing, rule)
