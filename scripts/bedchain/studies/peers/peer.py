# SPDX-License-Identifier: GPL-3.0-or-later
"""What one code is, and what one run of it leaves behind."""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from pathlib import Path

from bedchain.studies.peers.bed import Bed


@dataclass(frozen=True)
class Outcome:
    """One run, without start and end of the program.

    Attributes
    ----------
    simulated_s : float
        Simulated time that was timed [s].
    wall_s : float
        Wall time that it took [s].
    particles : int
        Particles at the end [1].
    dem_steps : int
        Steps of the particles in the timed part [1].
    mean_height_m : float
        Mean height of the particles' centres at the end [m].
    pressure_drop : float
        Mean over the second half of the run, without the gas's own weight [Pa]; NaN without gas.
    dem_s, exchange_s, gas_s : float
        Split of the wall time, where the code tells it [s].
    """

    simulated_s: float
    wall_s: float
    particles: int
    dem_steps: int
    mean_height_m: float
    pressure_drop: float = nan
    dem_s: float = nan
    exchange_s: float = nan
    gas_s: float = nan


@dataclass(frozen=True)
class Peer:
    """A code that can run the bed.

    Attributes
    ----------
    name : str
        In the table.
    program : str
        Looked for on the path, or a file.
    package : str
        Debian package that holds it; empty for the project's own.
    gas : bool
        Whether it solves the gas too.
    differences : str
        What it does not do as bedFoam does.
    run : callable
        Bed, folder that it may empty, and simulated time [s] to an `Outcome`.
    cost_s : float
        Wall time of one particle's step, roughly [s]: long runs are cut by it, nothing else uses it.
    files : tuple of Path
        Files and folders of inputs of its own; where they change, its runs are made again.
    ranks : int
        MPI ranks.
    """

    name: str
    program: str
    package: str
    gas: bool
    differences: str
    run: Callable[[Bed, Path, float], Outcome]
    cost_s: float
    files: tuple[Path, ...]
    ranks: int = 1
