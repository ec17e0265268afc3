# SPDX-License-Identifier: GPL-3.0-or-later
"""MPI ranks of a simulation that takes what is free: on a busy machine ranks wait for each other."""

import os
from collections.abc import Mapping

from bedchain.case.chosen import AUTO
from bedchain.case.rank_checks import most_sharing


def free_cores(cores: int) -> int:
    """Cores of some that the load of the last minute leaves free, at least one [1].

    Two ranks beside another busy process took 547 s where one rank took 40: a rank waits for its neighbour.
    """
    return max(1, min(cores, round((os.cpu_count() or 1) - os.getloadavg()[0])))


def ranks_of(given: str, cores: int, parameters: Mapping[str, float | str]) -> int:
    """MPI ranks by a number or `AUTO` [1].

    Parameters
    ----------
    given : str
        A whole number, or `AUTO`.
    cores : int
        That the ranks may use [1].
    parameters : mapping
        Of `dem.segments.read_parameters`.
    """
    if given != AUTO:
        return int(given)
    return most_sharing(int(parameters["gas_cells_x"]), free_cores(cores))
