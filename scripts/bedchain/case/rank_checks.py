# SPDX-License-Identifier: GPL-3.0-or-later
"""MPI ranks of a case: slabs that they can share, and how many there may be."""

import os
from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.case.chosen import AUTO
from bedchain.case.parameters import SKIN_MOST
from bedchain.case.parcels import parcel_case
from bedchain.case.schema import Case
from bedchain.physics.whole_numbers import ratio

SLAB_MIN = SKIN_MOST / 2  # diameters: a particle moves as far before it is given to another rank


@reads("run.ranks", "gas.cell_size_m", "bed.width_m")
def ranks_share_gas_evenly(ranks: int, cell: float, width: float) -> Iterator[Finding]:
    """Refuse ranks that do not divide the gas cells along the width evenly."""
    cells = ratio(width, cell)
    if cells.denominator == 1 and cells % ranks:
        wrong = f"{ranks} ranks cannot share {cells} gas cells along the width evenly"
        yield (
            "run.ranks",
            wrong,
            f"take run.ranks: {most_sharing(int(cells), ranks)}, or another gas.cell_size_m",
        )


@reads("run.ranks", "bed.width_m", "particles.diameter_m", "particles.parcel_diameters")
def slabs_are_wider_than_a_step_of_the_list(
    ranks: int, width: float, diameter: float, size: float
) -> Iterator[Finding]:
    """Refuse slabs so narrow that a particle may cross one between two lists of neighbours."""
    least = SLAB_MIN * diameter * size
    if ranks > 1 and width / ranks < least:
        wrong = f"{ranks} make slabs of {width / ranks:.3g} m, below half a neighbour skin ({least:.3g} m)"
        yield "run.ranks", wrong, f"take at most {max(1, int(width / least))}"


def most_sharing(cells: int, ranks: int) -> int:
    """The most ranks up to a number that share cells evenly [1]."""
    return next(number for number in range(min(cells, ranks), 0, -1) if cells % number == 0)


def cores_here() -> int:
    """Cores that this process may use [1]: the machine's, or those of its job."""
    return len(os.sched_getaffinity(0))


def most_ranks(case: Case, cores: int | None = None) -> int:
    """MPI ranks of a checked case [1]; of `AUTO` the most that cores can take and that share the bed evenly.

    Parameters
    ----------
    case : dict
    cores : int, optional
        By default those of this machine or job [1].
    """
    ranks, cores = case["run"]["ranks"], cores or cores_here()
    if ranks != AUTO:
        return int(ranks)
    bed, width = parcel_case(case)["particles"]["diameter_m"], case["bed"]["width_m"]
    slabs = max(1, int(width / (SLAB_MIN * bed)))
    if case["gas"]["model"] == "none":
        return min(slabs, cores)
    return most_sharing(int(ratio(width, case["gas"]["cell_size_m"])), min(slabs, cores))
