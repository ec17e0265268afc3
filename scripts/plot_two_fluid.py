# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed as two fluids: height, pressure drop and its spectrum, voidage by height, mixing by its flow."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.measures.spectrum import spectrum
from bedchain.physics.bubbling_bed import bubbling_bed
from bedchain.physics.two_phase import RegimeError
from bedchain.stage import LOG, run_stage
from bedchain.studies.two_fluid_summary import Summary, piece_of, read_summary

COLOURS = {"left": "#4477aa", "right": "#66ccee", "low": "#ee6677", "up": "#ccbb44"}
DASHES = {"frames": "-", "mean_flow": ":"}


def plot_two_fluid(record: Path, files: FigureFiles, metrics: Path, case: Case) -> None:
    """Draw the summary of a two-fluid run, and write its numbers.

    Parameters
    ----------
    record : Path
        ``record.json`` in the folder of the summary.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    metrics : Path
        Table to make: quantity, source, value, unit.
    case : dict
    """
    summary = read_summary(record.parent)
    write_csv(numbers_of(summary), metrics)
    with figure_style():
        size = DOUBLE_COLUMN_IN, 0.75 * DOUBLE_COLUMN_IN
        figure, panels = plt.subplots(2, 3, figsize=size)
        height, pressure, power, voidage, radial, axial = panels.flat
        height.plot(summary.series["time_s"], summary.series["mean_height_m"], color="#222222", lw=0.7)
        height.set(xlabel="time [s]", ylabel="mean height of the solids [m]", ylim=(0, None))
        pressure.plot(
            summary.pressure["time_s"], summary.pressure["pressure_drop_Pa"] / 1000, color="#222222", lw=0.4
        )
        pressure.set(xlabel="time [s]", ylabel="pressure drop [kPa]", ylim=(0, None))
        powers = draw_spectrum(power, summary, case)
        profiles = draw_voidage(voidage, summary, case)
        curves = [draw_mixing(axes, summary, name) for axes, name in ((radial, "radial"), (axial, "axial"))]
        files.save(figure)
    write_csv(pd.concat([powers, profiles, *curves], ignore_index=True), files.csv)


def numbers_of(summary: Summary) -> pd.DataFrame:
    """Means over the window, bubbles, spectrum, what carries the weight and the cost, as metrics.csv."""
    record = summary.record
    within = summary.series[summary.series["time_s"].between(*record["window_s"])]
    rows = [
        ("mean_height", within["mean_height_m"].mean(), "m"),
        ("share_low", within["share_low_1"].mean(), "1"),
        ("pressure_drop", record["pressure_drop_Pa"], "Pa"),
        ("pressure_drop_std", record["pressure_drop_std_Pa"], "Pa"),
        ("pressure_frequency", record["pressure_frequency_Hz"], "Hz"),
        ("pressure_frequency_resolution", record["pressure_frequency_resolution_Hz"], "Hz"),
        ("bubble_diameter", record["bubble_diameter_m"], "m"),
        ("bubble_velocity", record["bubble_velocity_m_s"], "m/s"),
        *((f"{name}_over_weight", share, "1") for name, share in record.get("carries_weight_1", {}).items()),
        ("cpu_time_over_simulated_time", record["cpu_s_per_s"], "1"),
    ]
    table = pd.DataFrame(rows, columns=["quantity", "value", "unit"]).dropna()
    table.insert(1, "source", "two_fluid")
    return table


def draw_spectrum(axes: Axes, summary: Summary, case: Case) -> pd.DataFrame:
    """Share of the pressure drop's variance by frequency, over the window."""
    within = summary.pressure[summary.pressure["time_s"].between(*summary.record["window_s"])]
    seen = spectrum(within["time_s"], within["pressure_drop_Pa"], piece_of(case))
    axes.plot(seen.frequencies_hz, seen.power, color="#222222")
    axes.set(xlabel="frequency [Hz]", ylabel="share of the variance", xlim=(0, 10), ylim=(0, None))
    return pd.DataFrame(
        {"panel": "spectrum", "x": seen.frequencies_hz, "y": seen.power, "source": "two_fluid"}
    )


def draw_voidage(axes: Axes, summary: Summary, case: Case) -> pd.DataFrame:
    """Voidage by height, beside the two-phase model where the bed is in its range."""
    heights, voidage = summary.profile["height_m"].to_numpy(), summary.profile["voidage_1"].to_numpy()
    axes.plot(voidage, heights, color="#222222", label="two fluids")
    rows = [pd.DataFrame({"panel": "voidage", "x": voidage, "y": heights, "source": "two_fluid"})]
    try:
        bed = bubbling_bed(scene_of(case))
    except RegimeError as error:
        LOG.info("two-phase: %s", error)
    else:
        below = np.array(
            [bed.share_below(height) for height in np.append(heights - heights[0], 2 * heights[-1])]
        )
        solids = np.diff(below) / np.diff(np.append(heights - heights[0], heights[-1] + heights[0]))
        area = case["bed"]["width_m"] * case["bed"]["thickness_m"]
        volume = case["particles"]["number"] * np.pi / 6 * case["particles"]["diameter_m"] ** 3
        expected = 1 - solids * volume / area
        axes.plot(expected, heights, color="#997700", ls="--", label="two-phase model")
        rows.append(pd.DataFrame({"panel": "voidage", "x": expected, "y": heights, "source": "two_phase"}))
    axes.set(xlabel="voidage", ylabel="height [m]", ylim=(0, None))
    axes.legend()
    return pd.concat(rows, ignore_index=True)


def draw_mixing(axes: Axes, summary: Summary, direction: str) -> pd.DataFrame:
    """Share of each group still on its side; the chain of the mean flow dotted."""
    table = summary.mixing[summary.mixing["direction"] == direction]
    for (source, group), part in table.groupby(["source", "group"], sort=False):
        label = group if source == "frames" else None
        axes.plot(
            part["time_s"], part["fraction_remaining_1"], DASHES[source], color=COLOURS[group], label=label
        )
    axes.set(xlabel="time [s]", ylabel="share on its side", ylim=(0, 1.02))
    axes.legend()
    x, y = table["time_s"], table["fraction_remaining_1"]
    return pd.DataFrame(
        {"panel": direction, "x": x, "y": y, "source": table["source"] + " " + table["group"]}
    )


if rule := globals().get("snakemake"):
    run_stage(plot_two_fluid, rule)
