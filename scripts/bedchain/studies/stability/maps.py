# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability maps: outcomes of the settings over the varied numbers, with the limits by theory as lines."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bedchain.case.bed_checks import RAYLEIGH_SHARE_MAX
from bedchain.case.gas_checks import COURANT_MAX
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, figure_style, save_figure
from bedchain.files import write_csv
from bedchain.physics.scene_numbers import contact_duration, gas_relaxation_time
from bedchain.studies.stability import theory
from bedchain.studies.stability.bed_settings import FIXED, FLUIDIZED, SMALL
from bedchain.studies.stability.beds import StabilityBed, scene
from bedchain.studies.stability.settings import ON, is_of_chains
from bedchain.studies.stability.verdict import OUTCOMES

RESOLUTION_DPI = 200
# Okabe and Ito 2008, and a shape for each outcome
MARKS = dict(
    zip(
        OUTCOMES,
        (
            *(("o", "#009e73"), ("D", "#e69f00"), ("s", "#0072b2")),
            *(("X", "#d55e00"), ("P", "#cc79a7"), ("*", "#000000")),
        ),
        strict=True,
    )
)
LINES = ("-", "--", ":")


def draw_maps(table: pd.DataFrame, folder: Path) -> None:
    """Draw a map of each kind that the table has settings for: .png, .pdf and the numbers as .csv.

    Parameters
    ----------
    table : DataFrame
        Of `study.run_study`.
    folder : Path
    """
    for name, groups, draw in (
        ("steps", ("dem_step", "collision_time"), draw_steps),
        ("gas_steps", ("gas_step",), draw_gas_steps),
        ("others", ("density", "velocity", "packing", "gas_cell", "ranks"), draw_over_limit),
        ("chains", tuple(filter(is_of_chains, table["group"].unique())), draw_chains),
    ):
        part = table[table["group"].isin(groups)].dropna(axis="columns", how="all")
        if len(part):
            with figure_style():
                save_figure(draw(part), folder / f"{name}.png", folder / f"{name}.pdf", RESOLUTION_DPI)
            write_csv(part, folder / f"{name}.csv")


def mark(axes: Axes, x: pd.Series, y: pd.Series, outcomes: pd.Series) -> None:
    """A mark for each setting, by its outcome."""
    for outcome, (shape, colour) in MARKS.items():
        here = (outcomes == outcome).to_numpy()
        axes.plot(
            np.asarray(x)[here], np.asarray(y)[here], shape, color=colour, markersize=5,
            markeredgecolor="white", markeredgewidth=0.4, linestyle="none", zorder=3,
        )  # fmt: skip


def marks_legend(axes: Axes, outcomes: pd.Series, lines: list[Line2D] | None = None, **place: Any) -> None:
    """Legend of the outcomes in the map, and of lines."""
    handles = [
        Line2D([], [], marker=shape, color=colour, linestyle="none", markersize=5, label=name)
        for name, (shape, colour) in MARKS.items()
        if (outcomes == name).any()
    ]
    axes.legend(handles=handles + (lines or []), **place)


def draw_steps(table: pd.DataFrame) -> Figure:
    """Step over the Rayleigh time by stiffness, guard off where it refuses; three limits as lines."""
    young = np.geomspace(5e3, 2e9, 60)
    beds = [scene(replace(SMALL, young=value)) for value in young]
    rayleigh = np.array([theory.rayleigh(bed) for bed in beds])
    limits = (
        (np.full(len(young), RAYLEIGH_SHARE_MAX), "refused above: 20 % of it"),
        ([theory.oscillator_step(bed, SMALL.number) for bed in beds] / rayleigh, r"$2/\omega$, bed at rest"),
        ([contact_duration(bed) for bed in beds] / rayleigh, "duration of a collision"),
    )
    run = table[(table["guards"] != ON) | (table["outcome"] != "refused")]
    figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.8), sharex=True, sharey=True)
    titles = {"dem_step": "bed at rest", "collision_time": "collisions"}
    for axes, (group, title) in zip(panels, titles.items(), strict=True):
        part = run[run["group"] == group]
        lines = [
            axes.plot(young, y, style, color=LINE_COLOUR, linewidth=0.9, label=name)[0]
            for (y, name), style in zip(limits, LINES, strict=True)
        ]
        scale = [theory.rayleigh(scene(replace(SMALL, young=value))) for value in part["young_Pa"]]
        mark(axes, part["young_Pa"], part["dem_step_s"] / scale, part["outcome"])
        axes.loglog()
        axes.set_title(title)
        axes.set_xlabel("Young's modulus [Pa]")
    panels[0].set_ylabel("DEM step over the Rayleigh time [1]")
    marks_legend(panels[1], run["outcome"], lines, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def draw_gas_steps(table: pd.DataFrame) -> Figure:
    """Gas step over the gas's drag relaxation time by Courant number, for a fixed and a fluidized bed."""
    figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.8), sharex=True, sharey=True)
    for axes, share, name in zip(panels, (FIXED, FLUIDIZED), ("fixed", "fluidized"), strict=True):
        part = table[table["setting"].str.contains(f"{share:g} u_mf", regex=False)]
        scenes = [
            scene(StabilityBed(diameter=row.diameter_m, velocity=row.velocity_m_s))
            for row in part.itertuples()
        ]
        relaxation = np.array([gas_relaxation_time(bed) for bed in scenes])
        courant = part["gas_step_s"].to_numpy() / [theory.courant_limit(bed, 1.0).value for bed in scenes]
        mark(axes, part["gas_step_s"] / relaxation, courant, part["outcome"])
        axes.axhline(COURANT_MAX, color=LINE_COLOUR, linewidth=0.9)
        axes.axvline(2.0, color=LINE_COLOUR, linewidth=0.9, linestyle="--")
        axes.loglog()
        axes.set_title(f"{name}, {share:g} of $u_{{mf}}$")
        axes.set_xlabel("gas step over its drag relaxation time [1]")
    lines = [
        Line2D([], [], color=LINE_COLOUR, linewidth=0.9, label="refused above, Courant number 1"),
        Line2D([], [], color=LINE_COLOUR, linewidth=0.9, linestyle="--", label="explicit drag is unstable"),
    ]
    panels[0].set_ylabel("Courant number of the gas [1]")
    marks_legend(panels[1], table["outcome"], lines, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def draw_over_limit(table: pd.DataFrame) -> Figure:
    """Every other setting of particles and gas over its limit by theory, in rows."""
    part = table[np.isfinite(table["over_limit_1"]) & (table["over_limit_1"] > 0)]
    figure, axes = plt.subplots(figsize=(DOUBLE_COLUMN_IN / 1.2, 0.19 * len(part) + 0.9))
    rows = pd.Series(np.arange(len(part))[::-1])
    mark(axes, part["over_limit_1"], rows, part["outcome"])
    axes.axvline(1.0, color=LINE_COLOUR, linewidth=0.9)
    names = part["setting"] + " (" + part["limited"].str.split(" [", regex=False).str[0] + ")"
    axes.set_yticks(rows, names)
    axes.set_xscale("log")
    axes.set_xlabel("setting over its limit by theory [1]")
    line = Line2D([], [], color=LINE_COLOUR, linewidth=0.9, label="limit")
    marks_legend(axes, part["outcome"], [line], loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return figure


def draw_chains(table: pd.DataFrame) -> Figure:
    """Every setting of the chains by model."""
    pairs = zip(table["setting"], table["model"], strict=True)
    part = table.assign(row=[name.replace(f", {model}", "") for name, model in pairs])
    names = list(dict.fromkeys(part["row"]))[::-1]
    kinds = list(dict.fromkeys(part["model"]))
    figure, axes = plt.subplots(figsize=(DOUBLE_COLUMN_IN / 1.4, 0.2 * len(names) + 0.9))
    mark(axes, part["model"].map(kinds.index), part["row"].map(names.index), part["outcome"])
    axes.set_xticks(range(len(kinds)), kinds)
    axes.set_yticks(range(len(names)), names)
    axes.set_xlabel("model [name]")
    axes.margins(x=0.1, y=0.03)
    axes.grid(linewidth=0.3)
    marks_legend(axes, part["outcome"], loc="lower center", bbox_to_anchor=(0.4, 1.0), ncols=4)
    return figure
