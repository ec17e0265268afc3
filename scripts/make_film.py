# SPDX-License-Identifier: GPL-3.0-or-later
"""A film of the comparison: particles of the DEM, voidage, particles of the chains: figures/film.mp4."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.figures.film import Canvas, Places, at_film_steps, in_their_cells, pixel_size, voidages
from bedchain.figures.film_frame import FilmFrame
from bedchain.figures.model_styles import label
from bedchain.figures.style import figure_style
from bedchain.files import atomic_file
from bedchain.measures.voidage import Slab
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Frames, Window, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation, open_bed
from bedchain.trajectory.store import BedFiles

FRAMES_PER_SECOND = 20
# constant quality: a bit rate would blur the clock; at 40 a chain's single particles melt into blots, at 32
# files are 1.7 times as large; more effort takes 2.4 times the time and saves 2 %
QUALITY, EFFORT = "36", "veryfast"
# colours get more bits than light: particles of two or three pixels go grey without
COLOURS = "chroma-qp-offset=-6"
# freeboard without particles is not shown, but for this share of the height shown
FREEBOARD = 0.1
VOIDAGE_COLOURS, VOIDAGE_LIMITS = "Blues_r", (0.35, 1.0)
DEM, VOIDAGE, FIRST_CHAIN = 0, 1, 2  # panels


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
    bed: BedFiles, transitions: list[Path], film: Path, comparison: Window, halves: Halves, slab: Slab,
    cell_size_m: float, seed: int,
) -> None:  # fmt: skip
    """Draw every step of the first chain, particles in the colour of the half that they started in.

    Parameters
    ----------
    bed : BedFiles
    transitions : list of Path
        ``transitions_<model>.npz`` of the chains to show.
    film : Path
        mp4 to make.
    comparison : Window
    halves : Halves
    slab : Slab
    cell_size_m : float
        Size of the gas cells, in which the voidage is shown [m].
    seed : int
        Of the chains' Monte Carlo runs, and of where in its cell each particle is drawn.
    """
    run, chains = open_bed(bed), [registry.load(file) for file in transitions]
    frames = run.window(comparison)
    lag = lag_frames(chains[0].lag_s, frames.interval_s)
    total = (len(frames.times_s) - 1) // lag + 1
    size = run.width_m, min(run.height_m, (1 + FREEBOARD) * float(max(z.max() for z in frames.z_m)))
    pixel_m = pixel_size(*size, slab.diameter_m, FIRST_CHAIN + len(chains))
    canvas = Canvas(*size, slab.diameter_m, pixel_m, halves.colours)
    gas = Grid(run.width_m, run.height_m, *(round(at / cell_size_m) for at in (run.width_m, run.height_m)))
    generators = np.random.default_rng(seed).spawn(len(chains))
    places = [
        chain_places(chain, run, comparison, rng, (lag, total))
        for chain, rng in zip(chains, generators, strict=True)
    ]
    with figure_style():
        frame = film_frame(canvas, [panel_name(chain, chains[0].lag_s) for chain in chains], halves.colours)
    pictures = painted(frame, canvas, frames, lag, halves, voidages(frames, lag, gas, slab), gas, places)
    write_film(film, frame.shape, tqdm(pictures, "make_film", total, disable=None))
    LOG.info("%d frames, %.1f MB in %s", total, film.stat().st_size / 1e6, film)


def panel_name(chain: Chain, lag_s: float) -> str:
    """Name of a chain, and its lag where that is not the film's."""
    return label(chain.name) if chain.lag_s == lag_s else f"{label(chain.name)}, {chain.lag_s:g} s"


def chain_places(
    chain: Chain, run: Realisation, comparison: Window, rng: np.random.Generator, film: tuple[int, int]
) -> Iterator[Places]:
    """Positions of all particles by a Monte Carlo run of a chain, at every frame of the film.

    Parameters
    ----------
    chain : Chain
    run : Realisation
    comparison : Window
    rng : Generator
    film : (int, int)
        Frames of the DEM between two of the film, and frames of the film [1].
    """
    lag = lag_frames(chain.lag_s, run.interval_s)
    start = run.up_to(comparison.start_s, lag, chain.grid)
    for_paths, for_places = rng.spawn(2)
    paths = chain.paths(start, (film[1] - 1) * film[0] // lag, for_paths)
    shares = for_places.random((2, start.x_m.shape[1]))
    return at_film_steps(in_their_cells(paths, chain.grid, shares), lag, *film)


def painted(
    frame: FilmFrame, canvas: Canvas, frames: Frames, lag: int, halves: Halves,
    voidage: Iterable[NDArray[np.float64]], gas: Grid, places: list[Iterator[Places]],
) -> Iterator[NDArray[np.uint8]]:  # fmt: skip
    """The frame, painted anew for every step of the film."""
    left = frames.x_m[0] < halves.split_x_m
    dem = zip(frames.x_m[::lag], frames.z_m[::lag], strict=True)
    for time_s, of_gas, *particles in zip(frames.times_s[::lag], voidage, dem, *places, strict=True):
        frame.show_time(time_s)
        frame.paint(VOIDAGE, canvas.cells(of_gas, gas, VOIDAGE_LIMITS, VOIDAGE_COLOURS))
        for panel, (x, z) in zip((DEM, *range(FIRST_CHAIN, len(frame.panels))), particles, strict=True):
            frame.paint(panel, canvas.discs(x, z, left))
        yield frame.image


def write_film(film: Path, shape: tuple[int, int], pictures: Iterable[NDArray[np.uint8]]) -> None:
    """Write pictures of (rows, columns) pixels as a film, complete or not at all."""
    with atomic_file(film) as temporary:
        writer = imageio_ffmpeg.write_frames(
            str(temporary), shape[::-1], fps=FRAMES_PER_SECOND, quality=None, macro_block_size=2,
            output_params=["-crf", QUALITY, "-preset", EFFORT, "-x264-params", COLOURS],
        )  # fmt: skip
        writer.send(None)
        for picture in pictures:
            writer.send(picture)
        writer.close()


def film_frame(canvas: Canvas, chains: list[str], colours: list[str]) -> FilmFrame:
    """The panels and all that does not move."""
    frame = FilmFrame(["DEM", "voidage of the DEM", *chains], canvas)
    sides = list(zip(["from the left", "from the right"], colours, strict=True))
    for number in (DEM, *range(FIRST_CHAIN, FIRST_CHAIN + len(chains))):
        frame.legend(number, sides)
    frame.colour_bar(VOIDAGE, VOIDAGE_COLOURS, VOIDAGE_LIMITS)
    frame.draw()
    return frame


if rule := globals().get("snakemake"):
    run_stage(make_film, rule)
