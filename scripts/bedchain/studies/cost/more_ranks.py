# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of a bed on more ranks with a core each: its work by slabs, the fullest of which all wait for."""

from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.case.parameters import skin_diameters
from bedchain.case.parcels import parcel_case
from bedchain.case.rank_checks import SLAB_MIN, most_sharing
from bedchain.case.schema import Case
from bedchain.physics.whole_numbers import ratio
from bedchain.studies.cost.estimate import solver_wall
from bedchain.studies.cost.machine_speed import Speed, bed_of

MOST = 64
# A list of pairs reaches so many diameters and a skin (liggghts_inputs/include/style.in). Of the pairs within
# a reach R, centres spread evenly in a plane, 4 R / (3 pi w) lie across the borders of slabs w wide: their
# mean distance along x over w. Both ranks work on these. In a thick bed it is 3 R / (8 w), a tenth less.
REACH_DIAMETERS = 1.05
ACROSS = 4 / (3 * np.pi)


def ranks_that_share(case: Case) -> list[int]:
    """Numbers of ranks near 1, 2, 4 to `MOST` that a case can have."""
    case = parcel_case(case)
    width, diameter = case["bed"]["width_m"], case["particles"]["diameter_m"]
    slabs = max(1, int(width / (SLAB_MIN * diameter)))
    wanted = [min(2**power, slabs) for power in range(MOST.bit_length())]
    if case["gas"]["model"] != "none":
        cells = int(ratio(width, case["gas"]["cell_size_m"]))
        wanted = [most_sharing(cells, number) for number in wanted]
    return sorted(set(wanted))


def fullest_slab(x_m: NDArray[np.floating], width_m: float, ranks: int) -> float:
    """Particles of the fullest of equal slabs over the mean of all, mean over frames [1].

    Parameters
    ----------
    x_m : (n_frames, n_particles) array
        Across the bed, from 0 [m].
    width_m : float
        Of the bed [m].
    ranks : int
        Slabs.
    """
    fullest = []
    for frame in x_m:  # one after the other, since a large bed's frames fill the memory
        slab = np.clip((frame / width_m * ranks).astype(np.int64), 0, ranks - 1)
        fullest.append(np.bincount(slab).max())
    return float(np.mean(fullest) * ranks / x_m.shape[1])


def more_ranks(case: Case, speed: Speed, x_m: NDArray[np.floating] | None = None) -> pd.DataFrame:
    """Time of the simulation on more ranks, each with a core of this machine's speed, without messages.

    Parameters
    ----------
    case : dict
        A checked case.
    speed : Speed
        Of this machine.
    x_m : (n_frames, n_particles) array, optional
        Of the bed, where it is known; the particles are spread evenly else [m].

    Returns
    -------
    DataFrame
        A row for each number of ranks: ranks, fullest_slab_1, twice_1 (pairs that two ranks work on), wall_s,
        speedup_1.
    """
    bed, scene = bed_of(case), parcel_case(case)
    width, diameter = scene["bed"]["width_m"], scene["particles"]["diameter_m"]
    reach = (REACH_DIAMETERS + skin_diameters(bed.dem_step_s, diameter)) * diameter
    end_s = case["time"]["end_s"]
    here = solver_wall(bed, end_s, speed, cores=bed.ranks)  # a smaller rank's cache: left out
    rows = []
    for ranks in ranks_that_share(case):
        fullest = 1.0 if x_m is None else fullest_slab(x_m, width, ranks)
        twice = ACROSS * reach * (ranks - 1) / width
        gas = solver_wall(replace(bed, ranks=ranks), end_s, speed, cores=ranks)["gas"]
        wall_s = (here["dem"] * (1 + twice) + here["exchange"]) * fullest * bed.ranks / ranks + gas
        rows.append({"ranks": ranks, "fullest_slab_1": fullest, "twice_1": twice, "wall_s": wall_s})
    table = pd.DataFrame(rows)
    return table.assign(speedup_1=table["wall_s"].iloc[0] / table["wall_s"])
