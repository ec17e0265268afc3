# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles by their vertical velocity, beside the voidage that the gas sees at the same moment."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyvista
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from bedchain.dem.gas_field import GasField, gas_near
from bedchain.figures.style import (
    MOST_SLENDER,
    SINGLE_COLUMN_IN,
    FigureFiles,
    close_frame,
    figure_style,
)
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.store import BedFiles, read_manifest

GAS_COLOUR_MAP = "Blues_r"
# freeboard without particles is not shown, but for this share of the bed's height shown
FREEBOARD = 0.15
# faster particles, a few on top of bursting bubbles, have the colour of the ends
FAST_SHARE = 0.02
PIXELS_HIGH = 1600
# a disc of one colour, that of the bar, with a darker rim that parts it from those it touches
DISC = """//VTK::Color::Impl
float dist = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);
if (dist > 1.0) discard;
if (dist > 0.7) { ambientColor *= 0.75; diffuseColor *= 0.75; }
"""
TALLEST_IN = 5.0
# a narrower picture has no room for two numbers below it
NARROWEST_IN = 0.7


def plot_snapshot(
    dem: Path, bed: BedFiles, files: FigureFiles, time_s: float, diameter_m: float, colour_map: str
) -> None:
    """Draw particles and gas of the segment's end that is nearest to a time.

    Parameters
    ----------
    dem : Path
        ``dem.json``.
    bed : BedFiles
    files : FigureFiles
        Figure in two forms, and the particles and gas cells shown.
    time_s : float
        Wanted time [s].
    diameter_m : float
        Particle diameter [m].
    colour_map : str
        Matplotlib colour map of the velocity.
    """
    values, described = bed.open()
    gas = gas_near(read_manifest(dem), dem.parent, "voidage", time_s)
    frame = np.asarray(values[frame_at(np.array(described["times_s"]), gas.time_s)], float)
    LOG.info("particles and gas at %g s", gas.time_s)
    width = described["width_m"]
    height = min((1 + FREEBOARD) * frame[1].max(), described["height_m"], MOST_SLENDER * width)
    speed = np.quantile(np.abs(frame[3]), 1 - FAST_SHARE)
    norms = Normalize(-speed, speed), Normalize(gas.values.min(), 1.0)
    images = (
        render(_particles(frame, diameter_m), "vz", norms[0], colour_map, (width, height)),
        render({"mesh": gas.mesh}, "voidage", norms[1], GAS_COLOUR_MAP, (width, height)),
    )
    with figure_style():
        tall = min(1.3 * height / width, TALLEST_IN)
        figure, panels = plt.subplots(1, 2, figsize=(SINGLE_COLUMN_IN, tall + 1.0), sharey=True)
        _panel(panels[0], images[0], (width, height), norms[0], colour_map, "vertical velocity [m/s]")
        _panel(panels[1], images[1], (width, height), norms[1], GAS_COLOUR_MAP, "voidage [1]")
        panels[0].set_title(f"particles, {gas.time_s:.2f} s")
        panels[1].set_title("gas")
        panels[0].set_ylabel("z [m]")
        files.save(figure)
    write_csv(snapshot_table(frame, gas), files.csv)


def render(
    what: dict[str, Any], field: str, norm: Normalize, colour_map: str, size_m: tuple[float, float]
) -> np.ndarray:
    """Picture of a mesh or of particles seen along y, exactly the bed from corner to corner.

    Parameters
    ----------
    what : dict
        Arguments of `pyvista.Plotter.add_mesh`, and ``radius`` of particles [m].
    field : str
        Scalar that gives the colours.
    norm : Normalize
        Range of the colours.
    colour_map : str
    size_m : (float, float)
        Width and height shown [m].

    Returns
    -------
    (pixels high, pixels wide, 3) ndarray of uint8
    """
    # EGL draws without a screen; the default tries an X server first, and complains
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    width, height = size_m
    window = [max(1, round(PIXELS_HIGH * width / height)), PIXELS_HIGH]
    radius = what.pop("radius", None)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=window)
    plotter.set_background("white")
    actor = plotter.add_mesh(
        **what, scalars=field, cmap=colour_map, clim=[norm.vmin, norm.vmax],
        show_scalar_bar=False, lighting=False,
    )  # fmt: skip
    if radius is not None:
        actor.mapper.scale_factor = radius
        actor.mapper.SetSplatShaderCode(DISC)
    plotter.camera_position = [(width / 2, -1.0, height / 2), (width / 2, 0.0, height / 2), (0.0, 0.0, 1.0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2
    picture = plotter.screenshot(return_img=True)
    plotter.close()
    return np.asarray(picture)


def _particles(frame: np.ndarray, diameter_m: float) -> dict[str, Any]:
    """Particles as discs of their true size."""
    points = np.column_stack([frame[0], np.zeros(frame.shape[1]), frame[1]])
    cloud = pyvista.PolyData(points)
    cloud["vz"] = frame[3]
    return {"mesh": cloud, "style": "points_gaussian", "emissive": False, "radius": diameter_m / 2}


def _panel(
    axes: Axes, image: np.ndarray, size_m: tuple[float, float], norm: Normalize, colours: str, label: str
) -> None:
    axes.imshow(image, extent=(0, size_m[0], 0, size_m[1]), interpolation="antialiased")
    axes.set(xlabel="x [m]", xlim=(0, size_m[0]), ylim=(0, size_m[1]))
    ends = [0, size_m[0]] if TALLEST_IN * size_m[0] / size_m[1] > NARROWEST_IN else [size_m[0]]
    axes.set_xticks(ends, [f"{end:g}" for end in ends])
    close_frame(axes)
    bar = axes.figure.colorbar(
        ScalarMappable(norm, colours), ax=axes, orientation="horizontal", shrink=0.9, aspect=14, pad=0.02,
        extend="both" if norm.vmin is not None and norm.vmin < 0 else "neither",
    )  # fmt: skip
    bar.set_label(label)
    bar.ax.locator_params(nbins=3)
    bar.outline.set_linewidth(0.5)


def snapshot_table(frame: np.ndarray, gas: GasField) -> pd.DataFrame:
    """Particles and gas cells of the picture.

    Parameters
    ----------
    frame : (4, n_particles) ndarray
        x, z [m], vx, vz [m/s].
    gas : GasField

    Returns
    -------
    DataFrame
        part (particle or gas_cell), x_m, z_m, vertical_velocity_m_s (particles), voidage_1 (gas cells).
    """
    particles = pd.DataFrame(
        {"part": "particle", "x_m": frame[0], "z_m": frame[1], "vertical_velocity_m_s": frame[3]}
    )
    cells = pd.DataFrame({"part": "gas_cell", "x_m": gas.x_m, "z_m": gas.z_m, "voidage_1": gas.values})
    return pd.concat([particles, cells], ignore_index=True)


if rule := globals().get("snakemake"):
    run_stage(plot_snapshot, rule)
