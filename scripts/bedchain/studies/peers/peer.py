# SPDX-License-Identifier: GPL-3.0-or-later
"""A code of the comparison, and the outcome of its run."""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from pathlib import Path

from bedchain.studies.peers.bed import PeerBed


@dataclass(frozen=True)
class Outcome:
    """Outcome of a run, without start and end of the program.

    Attributes
    ----------
    simulated_s : float
        Simulated time of the timed part [s].
    wall_s : float
        Wall time of the timed part [s].
    particles : int
        Particles at the end [1].
    dem_steps : int
        Steps of the particles in the timed part [1].
    mean_height_m : float
        Mean height of the particles' centres at the end [m].
    pressure_drop : float
        Mean over the second half of the run, less the weight of the gas [Pa]; NaN without gas.
    dem_s, exchange_s, gas_s : float
        Split of the wall time, where the code gives it [s].
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
        Name on the path, or a file.
    package : str
        Debian package; empty for bedFoam.
    gas : bool
        Whether it solves the gas too.
    differences : str
        Differences from bedFoam.
    run : callable
        Takes the bed, a folder that it may empty and the simulated time [s], returns an `Outcome`.
    cost_s : float
        Wall time of one particle's step, roughly [s]; only to cut long runs.
    files : tuple of Path
        Input files and folders of this code; where they change, its runs are repeated.
    ranks : int
        MPI ranks.
    """

    name: str
    program: str
    package: str
    gas: bool
    differences: str
    run: Callable[[PeerBed, Path, float], Outcome]
    cost_s: float
    files: tuple[Path, ...]
    ranks: int = 1
