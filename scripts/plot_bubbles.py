# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage and bubbles by height, simulated and by the two-phase model: bubbles.csv and a figure."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from bedchain.case.parcels import parcel_case
from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.measures.bubbles import VOID, by_height, followed_bubbles, voidage_maps
from bedchain.measures.voidage import Slab
from bedchain.physics.bubbling_bed import BubblingBed, bubbling_bed
from bedchain.physics.two_phase import RegimeError
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles

ROWS = 24  # of the profiles, over the height that holds `SHOWN_SHARE` of the particles
SHOWN_SHARE = 0.999
QUANTITIES = {
    "voidage_1": ("voidage", "1"),
    "diameter_m": ("bubble diameter", "m"),
    "velocity_m_s": ("rise velocity", "m/s"),
    "frequency_Hz": ("bubbles a second", "Hz"),
}
STYLES = {"dem": ("DEM", "#222222", "-"), "two_phase": ("two-phase model", "#ee6677", "--")}
NOTE = """Bubble: connected cells of the gas grid with a voidage above {void:g} that do not reach the
freeboard; diameter of a circle of its area, mean over bubbles. Rise velocity and number a second over the
width: of bubbles known again in the next frame ({share:.0f} % of them), so that the number is a lower bound.
{model}"""


def plot_bubbles(
    bed: BedFiles, files: FigureFiles, window: Window, case: Case, bubbles: Path,
) -> None:  # fmt: skip
    """Measure voidage and bubbles over learning and comparison; draw them beside the two-phase model.

    Parameters
    ----------
    bed : BedFiles
    files : FigureFiles
    window : Window
        From the start of the learning to the end of the comparison.
    case : dict
        The sections bed, particles, contact and gas of a checked case.
    bubbles : Path
        Table to make: every bubble, with its frame, place and diameter.

    Raises
    ------
    DataError
        The window has fewer than two frames.
    """
    store, described = bed.open()
    frames = window.frames(np.array(described["times_s"]))
    cell_m, interval_s = case["gas"]["cell_size_m"], described["frame_interval_s"]
    size = described["height_m"], described["width_m"]
    moved = parcel_case(case)
    slab = Slab(moved["bed"]["thickness_m"], moved["particles"]["diameter_m"])
    maps = np.array([*voidage_maps(store[frames], size, cell_m, slab)])
    table, risen = followed_bubbles(maps, cell_m, interval_s, size[1])
    profile = maps.mean(axis=(0, 2))
    edges = np.linspace(0, top_of(profile, cell_m), ROWS + 1)
    measured = by_height(table, risen, edges, interval_s * (len(maps) - 1))
    heights = cell_m * (np.arange(len(profile)) + 0.5)
    measured["voidage_1"] = np.interp(measured["height_m"], heights, profile)
    tables = {"dem": measured}
    try:
        model = bubbling_bed(scene_of(case))
    except RegimeError as error:
        note = f"Two-phase model: none, {error.regime}."
    else:
        tables["two_phase"] = model_table(model, size[1])
        note = f"Two-phase model: {model.regime} bubbles, nothing fitted; it ends at the bed's surface."
    shown = long_form(tables)
    draw(shown, files, NOTE.format(void=VOID, share=100 * len(risen) / max(len(table), 1), model=note))
    write_csv(shown, files.csv)
    write_csv(table, bubbles)
    LOG.info("%d bubbles in %d frames, %d known again", len(table), len(maps), len(risen))


def top_of(voidage: np.ndarray, cell_m: float) -> float:
    """Height below which `SHOWN_SHARE` of the particles are, from the mean voidage of rows of cells [m]."""
    held = np.cumsum(1 - voidage)
    return cell_m * (int(np.searchsorted(held, SHOWN_SHARE * held[-1])) + 1)


def model_table(model: BubblingBed, width_m: float) -> pd.DataFrame:
    """The model's profiles in the columns of `by_height`; bubbles a second through the slab's width.

    Bubbles of one diameter are discs in the slab: ``delta u_b W / (pi d_b^2 / 4)``.
    """
    shown = slice(len(model.height) // 40, None, len(model.height) // 200)  # not where bubbles have no size
    diameter, velocity = model.bubble_diameter[shown], model.bubble_velocity[shown]
    return pd.DataFrame(
        {
            "height_m": model.height[shown],
            "voidage_1": model.voidage()[shown],
            "diameter_m": diameter,
            "velocity_m_s": velocity,
            "frequency_Hz": model.bubble_share[shown] * velocity * width_m / (np.pi / 4 * diameter**2),
        }
    )


def long_form(tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Profiles by source as quantity, source, height_m, value, unit."""
    parts = [
        table[["height_m", name]]
        .set_axis(["height_m", "value"], axis=1)
        .assign(quantity=title, source=source, unit=unit)
        for source, table in tables.items()
        for name, (title, unit) in QUANTITIES.items()
    ]  # fmt: skip
    return pd.concat(parts, ignore_index=True)[["quantity", "source", "height_m", "value", "unit"]]


def draw(shown: pd.DataFrame, files: FigureFiles, note: str) -> None:
    """A panel for each quantity, height upwards."""
    with figure_style():
        figure, panels = plt.subplots(1, len(QUANTITIES), figsize=(DOUBLE_COLUMN_IN, 2.9), sharey=True)
        for axes, (title, unit) in zip(panels, QUANTITIES.values(), strict=True):
            for source, (name, colour, style) in STYLES.items():
                rows = shown[(shown["quantity"] == title) & (shown["source"] == source)]
                if len(rows):
                    axes.plot(rows["value"], rows["height_m"], style, color=colour, label=name)
            axes.set_xlabel(f"{title} [{unit}]")
        dem = shown[shown["source"] == "dem"]
        seen = dem.loc[dem["quantity"] == "bubbles a second", "value"].max()
        panels[-1].set_xlim(0, 3 * seen if seen > 0 else None)
        panels[0].set(ylabel="z [m]", ylim=(0, None))
        panels[0].legend(loc="lower right")
        footnote(figure, note)
        files.save(figure)


if rule := globals().get("snakemake"):
    run_stage(plot_bubbles, rule)
