# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory that a case needs, and its check against this machine before the start."""

from pathlib import Path

from tqdm import tqdm

from bedchain.case.parcels import parcel_case
from bedchain.case.rank_checks import most_ranks
from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.meter import physical_memory_bytes
from bedchain.physics.whole_numbers import ratio

# Measured on the short and the paper's bed: mpirun and Python, and each rank; on a million particles on two
# ranks, which take 1.99 GB while they write a restart: each particle of the coupled solver
RUN_BYTES, RANK_BYTES, PARTICLE_BYTES = 96e6, 87e6, 1.7e3
GAS_CELL_BYTES = 2e3  # an estimate: some 100 fields, matrices and addresses of 8 bytes, twice
JOB_BYTES = 230e6  # of a job of the chains: Python and its packages
MOVE_BYTES = 23.0  # of a particle over a frame of the learning window: (580 - 230) MB for 15.5 million
DISTANCE_BYTES = 8  # of two frames of the recurrence chain
GROUPS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")


def memory_needs(case: Case) -> dict[str, float]:
    """Estimated memory of the two largest parts of a case: its simulation, and the learning of its chains.

    Parameters
    ----------
    case : dict
        A checked case, of `case.load.load_case`.

    Returns
    -------
    dict of str to float
        Bytes by the name of the part.
    """
    case = parcel_case(case)
    bed, cell, number = case["bed"], case["gas"]["cell_size_m"], case["particles"]["number"]
    deep = max(1.0, bed["thickness_m"] / cell) if bed["layers"] == "many" else 1.0
    gas_cells = bed["width_m"] * bed["height_m"] / cell**2 * deep if case["gas"]["model"] != "none" else 0.0
    learn_s = case["learning"]["end_s"] - case["learning"]["start_s"]
    frames = float(ratio(learn_s, case["time"]["frame_interval_s"]))
    distances = frames**2 * DISTANCE_BYTES if "recurrence" in case["chain"]["models"] else 0.0
    return {
        "the simulation": solver_bytes(number, most_ranks(case)) + gas_cells * GAS_CELL_BYTES,
        "learning the chains": JOB_BYTES + number * frames * MOVE_BYTES + distances,
    }


def solver_bytes(number: int, ranks: int) -> float:
    """Memory of the coupled solver with a usual number of gas cells, by particles and MPI ranks [bytes]."""
    return RUN_BYTES + ranks * RANK_BYTES + number * PARTICLE_BYTES


def machine_bytes() -> float:
    """Memory of this machine, or of the group of processes that this one belongs to where that has less."""
    sizes = [float(physical_memory_bytes())]
    for file in map(Path, GROUPS):
        if file.exists() and (limit := file.read_text(encoding="utf-8").strip()).isdecimal():
            sizes.append(float(limit))
    return min(sizes)


def require_memory(case: Case) -> None:
    """Refuse a case that does not fit into the memory of this machine.

    Raises
    ------
    UserError
        Names the part, the memory that it needs, and the keys that make it large.
    """
    part, needed = max(memory_needs(case).items(), key=lambda item: item[1])
    if needed > (present := machine_bytes()):
        sizes = (tqdm.format_sizeof(size, "B") for size in (needed, present))
        raise UserError(
            "{}: {} needs about {} of memory, this machine has {}; take a smaller particles.number, "
            "a larger gas.cell_size_m, a shorter learning window, or a larger machine".format(
                case["title"], part, *sizes
            )
        )
