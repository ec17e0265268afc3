# SPDX-License-Identifier: GPL-3.0-or-later
"""A film of the comparison: particles of the DEM, their voidage, particles of a chain: figures/film.mp4."""

from dataclasses import dataclass
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from matplotlib import pyplot as plt
from matplotlib import rcParams
from matplotlib.animation import FFMpegWriter
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from tqdm import tqdm

from bedchain.chains import registry
from bedchain.figures.film import Canvas, in_their_cells, voidages
from bedchain.figures.style import close_frame, figure_style
from bedchain.files import atomic_file
from bedchain.measures.voidage import Slab
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles

FRAMES_PER_SECOND = 20
# of particles that change from frame to frame: 4 MB for 10 s
KILOBITS_PER_SECOND = 3200
HEIGHT_IN, DPI = 6.4, 150
# freeboard without particles is not shown, but for this share of the height shown
FREEBOARD = 0.1
VOIDAGE_COLOURS, VOIDAGE_LEAST = "Blues_r", 0.35


@dataclass(frozen=True)
class Halves:
    """Colours of the particles by the half that they started in.

    Attributes
    ----------
    split_x_m : float
        Line between left and right [m].
    colours : list of str
        Of particles that started left and right.
    """

    split_x_m: float
    colours: list[str]


def make_film(
    bed: BedFiles, transitions: Path, film: Path, comparison: Window, halves: Halves, slab: Slab,
    cell_size_m: float, seed: int,
) -> None:  # fmt: skip
    """Draw every step of the chain over the comparison, particles in the colour of the half they started in.

    Parameters
    ----------
    bed : BedFiles
    transitions : Path
        ``transitions_<model>.npz``.
    film : Path
        mp4 to make.
    comparison : Window
    halves : Halves
    slab : Slab
    cell_size_m : float
        Size of the gas cells, in which the voidage is shown [m].
    seed : int
        Of the chain's Monte Carlo run, and of where in its cell each particle is drawn.
    """
    run, chain = open_bed(bed), registry.load(transitions)
    frames = run.window(comparison)
    lag = lag_frames(chain.lag_s, frames.interval_s)
    start = run.up_to(comparison.start_s, lag)
    for_paths, for_places = np.random.default_rng(seed).spawn(2)
    top = min(run.grid.height_m, (1 + FREEBOARD) * float(max(z.max() for z in frames.z_m)))
    canvas = Canvas(run.grid.width_m, top, slab.diameter_m, halves.colours)
    left = frames.x_m[0] < halves.split_x_m
    dem = zip(frames.x_m[::lag], frames.z_m[::lag], strict=True)
    paths = chain.paths(start, (len(frames.times_s) - 1) // lag, for_paths)
    places = in_their_cells(paths, run.grid, for_places.random((2, left.size)))
    size = run.grid.width_m, top
    voidage = voidages(frames, lag, *size, cell_size_m, slab.thickness_m, slab.diameter_m)
    rcParams["animation.ffmpeg_path"] = imageio_ffmpeg.get_ffmpeg_exe()
    writer = FFMpegWriter(fps=FRAMES_PER_SECOND, bitrate=KILOBITS_PER_SECOND)
    with figure_style(), atomic_file(film) as temporary:
        # a film's frames are of even numbers of pixels
        wide = 2 * round(DPI * HEIGHT_IN * (2.4 * run.grid.width_m / top + 0.35) / 2) / DPI
        figure, panels = plt.subplots(1, 3, figsize=(wide, HEIGHT_IN), sharey=True)
        names = ("DEM", "voidage of the DEM", f"{chain.name} chain")
        images = [_panel(*pair, canvas) for pair in zip(panels, names, strict=True)]
        images[1].set(cmap=VOIDAGE_COLOURS, clim=(VOIDAGE_LEAST, 1.0))
        panels[0].set_ylabel("z [m]")
        title = figure.suptitle(" ", fontsize=9)
        steps = zip(frames.times_s[::lag], dem, voidage, places, strict=True)
        total = (len(frames.times_s) - 1) // lag + 1
        with writer.saving(figure, str(temporary), DPI):
            for time_s, of_dem, gas, of_chain in tqdm(steps, "make_film", total, disable=None):
                images[0].set_data(canvas.discs(*of_dem, left))
                images[1].set_data(gas)
                images[2].set_data(canvas.discs(*of_chain, left))
                title.set_text(f"{time_s:.3f} s")
                writer.grab_frame()
    LOG.info("%d frames, %.1f MB in %s", total, film.stat().st_size / 1e6, film)


def _panel(axes: Axes, name: str, canvas: Canvas) -> AxesImage:
    width, height = canvas.size_m
    image = axes.imshow(
        np.full((1, 1, 3), 255, np.uint8),
        extent=(0, width, 0, height),
        origin="lower",
        interpolation="antialiased",
    )
    axes.set(xticks=[0, width], xlabel="x [m]", xlim=(0, width), ylim=(0, height))
    axes.set_title(name)
    close_frame(axes)
    return image


if rule := globals().get("snakemake"):
    run_stage(make_film, rule)
