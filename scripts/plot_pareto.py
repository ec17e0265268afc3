# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against cost: all candidates where they were validated, the chosen ones where they were tested."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import BASELINE, ModelStyle, label, model_styles
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

WINDOW = "starts"
PANELS = {"radial": "test, left / right", "axial": "test, low / up"}
STARTS_DASH = (0, (1, 1.5))
# cells of one case as two tables have them, with the digits of a csv
SAME = 1e-6


def plot_pareto(
    scores: Path, selection: Path, files: FigureFiles, baseline_cell_m: float, baseline_lag_s: float
) -> None:
    """Draw rms errors over the processor time of moving every particle, with the noise floor.

    Parameters
    ----------
    scores, selection : Path
        ``scores.csv`` and ``selection.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    baseline_cell_m, baseline_lag_s : float
        The case's own cells [m] and lag [s].

    Raises
    ------
    UserError
        The scores hold no error of any model.
    """
    table = pareto_table(pd.read_csv(scores), pd.read_csv(selection), baseline_cell_m, baseline_lag_s)
    if not (table["panel"] != "validation").any():
        raise UserError(f"{scores} holds no test of a model; {make_again(scores)}")
    styles = model_styles(table["source"])
    with figure_style():
        figure, panels = plt.subplots(1, 3, figsize=(DOUBLE_COLUMN_IN, 3.0), sharex=True, sharey=True)
        _draw_validation(panels[0], table[table["panel"] == "validation"], styles)
        for axes, (panel, title) in zip(panels[1:], PANELS.items(), strict=True):
            _draw_test(axes, table[table["panel"] == panel], styles)
            axes.axhline(_spread_of_starts(scores, panel), color=LINE_COLOUR, lw=0.9, ls=STARTS_DASH)
            axes.set_title(title, loc="left")
        for axes in panels:
            axes.set(xscale="log")
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
            axes.set_axisbelow(True)
        panels[1].set_xlabel("processor time to move all particles over the comparison window [s]")
        panels[0].set_ylabel("rms error of the share [1]")
        panels[0].set_ylim(bottom=0)
        shown = [name for name in styles if (table["source"] == name).any()]
        figure.legend(handles=_legend(shown, styles), loc="outside upper center", ncols=4, handlelength=2.0)
        files.save(figure)
    write_csv(table, files.csv)


def pareto_table(
    scores: pd.DataFrame, selection: pd.DataFrame, baseline_cell_m: float, baseline_lag_s: float
) -> pd.DataFrame:
    """Error and cost of every candidate validated and of every setting tested.

    Parameters
    ----------
    scores, selection : DataFrame
        Of score_models.
    baseline_cell_m, baseline_lag_s : float
        The case's own cells [m] and lag [s].

    Returns
    -------
    DataFrame
        panel (validation, radial, axial), source, cell_m, lag_s, options, chosen, cost_s, error_1, ci_low_1,
        ci_high_1, noise_floor_1.
    """
    keys = ["model", "cell_m", "lag_s", "options"]
    scores, selection = (table.fillna({"options": ""}) for table in (scores, selection))
    valid = selection.dropna(subset="validation_rms").rename(
        columns={
            "paths_s": "cost_s",
            "validation_rms": "error_1",
            "ci_low": "ci_low_1",
            "ci_high": "ci_high_1",
        }
    )
    parts = [valid.assign(panel="validation")]
    cost = scores[scores["quantity"] == "paths_time"].set_index(keys)["value"].rename("cost_s")
    names = {"value": "error_1", "ci_low": "ci_low_1", "ci_high": "ci_high_1", "noise_floor": "noise_floor_1"}
    for panel in PANELS:
        which = (scores["quantity"] == f"error_rms_{panel}") & (scores["window"] == WINDOW)
        tested = scores[which & scores["time_s"].isna()].rename(columns=names)
        parts.append(tested.join(cost, on=keys).assign(panel=panel, chosen=1))
    table = pd.concat(parts, ignore_index=True)
    own = (
        (table["model"] == "static")
        & np.isclose(table["cell_m"], baseline_cell_m, rtol=SAME)
        & np.isclose(table["lag_s"], baseline_lag_s, rtol=SAME)
    )
    table["source"] = table["model"].where(~own, BASELINE)
    wanted = ["panel", "source", *keys[1:], "chosen", "cost_s", *names.values()]
    return table.reindex(columns=wanted)


def _draw_validation(axes: Axes, table: pd.DataFrame, styles: dict[str, ModelStyle]) -> None:
    for row in table.itertuples():
        style = styles[row.source]
        axes.plot(
            row.cost_s, row.error_1, style.marker, color=style.colour, ms=6 if row.chosen else 3,
            mfc="white" if row.source == BASELINE else style.colour,
            mec="black" if row.chosen else style.colour, alpha=1 if row.chosen else 0.6,
        )  # fmt: skip
    axes.set_title("validation, all candidates", loc="left")


def _draw_test(axes: Axes, table: pd.DataFrame, styles: dict[str, ModelStyle]) -> None:
    floor = table["noise_floor_1"].mean()
    if np.isfinite(floor):
        axes.axhline(floor, color=LINE_COLOUR, lw=1.0, ls=(0, (6, 2)))
        axes.axhspan(0, floor, color="#e8e8e8", lw=0, zorder=0)
    for row in table.itertuples():
        style = styles[row.source]
        axes.plot(
            row.cost_s, row.error_1, style.marker, color=style.colour, ms=6,
            mfc="white" if row.source == BASELINE else style.colour,
        )  # fmt: skip
        axes.vlines(row.cost_s, row.ci_low_1, row.ci_high_1, color=style.colour, lw=0.8)


def _spread_of_starts(scores: Path, panel: str) -> float:
    """What a model that knows nothing of the bubbles at the start errs by at least [1]."""
    table = pd.read_csv(scores)
    rows = table[(table["quantity"] == f"spread_of_starts_{panel}") & table["time_s"].isna()]
    return float(rows["value"].mean())


def _legend(shown: list[str], styles: dict[str, ModelStyle]) -> list[Line2D]:
    handles = [
        Line2D([], [], ls="none", marker=styles[name].marker, color=styles[name].colour, label=label(name),
               mfc="white" if name == BASELINE else styles[name].colour)
        for name in shown
    ]  # fmt: skip
    handles.append(Line2D([], [], color=LINE_COLOUR, ls=(0, (6, 2)), label="noise floor of the DEM"))
    handles.append(Line2D([], [], color=LINE_COLOUR, ls=STARTS_DASH, label="spread between starts"))
    chosen = Line2D([], [], ls="none", marker="o", ms=6, mfc="none", mec="black", label="black edge: chosen")
    return [*handles, chosen]


if rule := globals().get("snakemake"):
    run_stage(plot_pareto, rule)
