# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 2: seconds of computing to advance the comparison window, by the DEM and by each chain."""

import json
from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from bedchain.errors import UserError
from bedchain.figures.model_styles import label as model_label
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.trajectory.store import read_manifest

# label, marker, filled
KINDS = {
    "simulate": ("simulate", "s", True),
    "learn": ("learn from the DEM", "s", False),
    "exact": ("advance, exact expectation", "o", True),
    "monte_carlo": ("advance, Monte Carlo", "D", False),
}
ROW_IN = 0.21
# of the axis, right of the DEM, for the text beside the slowest chain
ROOM = 4.0


def plot_cost(
    timing: Path, dem: Path, provenance: list[Path], files: FigureFiles, colour: str, window_s: float
) -> None:
    """Draw what each model costs, on a logarithmic axis, with the ratios to the DEM.

    Parameters
    ----------
    timing : Path
        ``timing.csv`` of time_models.
    dem : Path
        ``dem.json``, for the cores of the DEM.
    provenance : list of Path
        ``provenance.json`` of the results, and last of the archive that the DEM is from, if any.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    colour : str
        Colour of the marks.
    window_s : float
        Length of the comparison window [s].
    """
    table = cost_table(pd.read_csv(timing))
    with figure_style():
        figure, axes = plt.subplots(figsize=(DOUBLE_COLUMN_IN, 1.2 + ROW_IN * len(table)))
        _draw(axes, table, colour)
        axes.set_xlabel(f"wall time for {window_s:g} s of bed [s]")
        figure.legend(handles=_legend(colour), loc="outside upper center", ncols=len(KINDS))
        footnote(figure, where_it_ran(read_manifest(dem)["ranks"], provenance))
        files.save(figure)
    write_csv(table, files.csv)


def cost_table(timing: pd.DataFrame) -> pd.DataFrame:
    """Costs of the models, from the stages that were timed.

    Parameters
    ----------
    timing : DataFrame
        Stages ``dem`` and ``<model>_count`` with ``<model>_matrix``, or ``<model>_learn``; ``<model>_exact``,
        ``<model>_monte_carlo``.

    Returns
    -------
    DataFrame
        model, kind (simulate, learn, exact, monte_carlo), wall_s, dem_over_this_1.

    Raises
    ------
    UserError
        A stage is missing.
    """
    wall = dict(zip(timing["stage"], timing["wall_s"], strict=True))
    models = [name.removesuffix("_exact") for name in timing["stage"] if name.endswith("_exact")]
    try:
        rows = [("dem", "simulate", wall["dem"])]
        for model in models:
            whole = f"{model}_learn" in wall
            parts = ("learn",) if whole else ("count", "matrix")
            rows.append((model, "learn", sum(wall[f"{model}_{part}"] for part in parts)))
            rows += [(model, kind, wall[f"{model}_{kind}"]) for kind in ("exact", "monte_carlo")]
    except KeyError as error:
        raise UserError(f"timing.csv has no stage {error}; make it again, by ./run --force") from error
    table = pd.DataFrame(rows, columns=["model", "kind", "wall_s"])
    table["dem_over_this_1"] = wall["dem"] / table["wall_s"]
    return table


def where_it_ran(ranks: int, provenance: list[Path]) -> str:
    """Cores and processors of the DEM and of the chains, in words."""
    chains, *archive = [json.loads(file.read_text(encoding="utf-8"))["machine"] for file in provenance]
    dem = (archive or [chains])[-1]
    cores = "one core" if ranks == 1 else f"{ranks} cores"
    return f"DEM: {cores} of {dem['processor']}. Chains: one core of {chains['processor']}."


def _legend(colour: str) -> list[Line2D]:
    return [
        Line2D([], [], label=name, marker=marker, ls="none", color=colour, mfc=colour if filled else "white")
        for name, marker, filled in KINDS.values()
    ]


def _draw(axes: Axes, table: pd.DataFrame, colour: str) -> None:
    dem = table.loc[table["kind"] == "simulate", "wall_s"].item()
    place = 0.0
    places, labels = [], []
    for row in table.itertuples():
        _, marker, filled = KINDS[str(row.kind)]
        place -= 1.5 if row.kind == "learn" else 1.0
        places.append(place)
        labels.append({"simulate": "DEM", "learn": model_label(str(row.model))}.get(str(row.kind), ""))
        axes.scatter(
            row.wall_s, place, marker=marker, s=26, zorder=3, facecolors=colour if filled else "white",
            edgecolors=colour, linewidths=1.1,
        )  # fmt: skip
        text = readable_seconds(row.wall_s)
        if row.kind not in ("simulate", "learn"):
            text += f"  =  DEM / {readable_ratio(row.dem_over_this_1)}"
        left = row.kind == "simulate"
        axes.annotate(
            text, (row.wall_s, place), (-8 if left else 8, 0), textcoords="offset points",
            ha="right" if left else "left", va="center", fontsize=7,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )  # fmt: skip
    axes.axvline(dem, color=colour, linewidth=0.7, linestyle=":", zorder=0)
    axes.set_xscale("log")
    axes.set_yticks(places, labels)
    axes.set_ylim(place - 0.8, -0.2)
    axes.set_xlim(table["wall_s"].min() / 2, max(2 * dem, ROOM * table["wall_s"].max()))
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


def readable_seconds(value: float) -> str:
    """Seconds with two significant digits and a unit that fits, such as ``3.1 ms``."""
    for factor, unit in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if value >= factor:
            return f"{_two_digits(value / factor)} {unit}"
    return f"{value:.1g} s"


def readable_ratio(value: float) -> str:
    """A ratio with two significant digits and thin spaces between thousands."""
    return f"{float(_two_digits(value)):,.0f}".replace(",", "\u2009") if value >= 10 else f"{value:.1f}"


def _two_digits(value: float) -> str:
    rounded = float(f"{value:.2g}")
    return f"{rounded:.0f}" if rounded >= 10 else f"{rounded:.1f}"


if rule := globals().get("snakemake"):
    run_stage(plot_cost, rule)
