# SPDX-License-Identifier: GPL-3.0-or-later
"""A small bed for the comparison with other codes, a code that takes given times, and logs of two codes."""

import numpy as np

from bedchain.case.parameters import Parameter
from bedchain.errors import UserError
from bedchain.studies.peers.bed import PeerBed
from bedchain.studies.peers.peer import Outcome, Peer

NUMBERS = {
    **{"width": 0.02, "height": 0.06, "thickness": 1e-3, "gas_cells_x": 4, "gas_cells_z": 12},
    **{"diameter": 1e-3, "density": 2600.0, "young": 1.9e6, "poisson": 0.3, "gravity": 9.81},
    **{"gas_step": 5e-4, "dem_step": 2e-5, "coupling_steps": 25},
}
PARTICLES = np.array(
    [[0.0005, 0.0005, 0.0, 0.1, 1e-3], [0.0051, 0.0099, -0.3, 0.4, 1e-3], [0.0195, 0.0305, 0.0, 0.0, 1e-3]]
)
LIGGGHTS_LOG = """Loop time of 9 on 1 procs for 10 steps with 8 atoms, finish time now
    Step    Atoms
Loop time of 1.5 on 1 procs for 250 steps with 9000 atoms, finish time Sun Nov 22 08:59:19 2026
"""
LAMMPS_LOG = """Per MPI rank memory allocation (min/avg/max) = 10.31 | 10.31 | 10.31 Mbytes
Step Atoms KinEng c_height
       0     9000 0.0008832624635 0.06212235678
    2500     9000 0.0008348 0.05601087419
Loop time of 6.45472 on 1 procs for 2500 steps with 9000 atoms
"""


def box() -> PeerBed:
    """Three particles in a box of 4 x 12 cells."""
    return PeerBed("box", [Parameter(name, value, "-", "test") for name, value in NUMBERS.items()], PARTICLES)


def timed_peer(name, costs, folder, calls, gas=False, fails=False, particles=3):
    """A code that takes the given wall times in turn, and notes its calls."""

    def run(bed, work, duration_s):
        calls.append(name)
        if fails:
            raise UserError(f"{name} has stopped\nits log: somewhere")
        work.mkdir(parents=True)
        wall = costs[calls.count(name) - 1]
        return Outcome(
            duration_s, wall, particles, bed.dem_steps(duration_s), 0.01, *([5.0, wall, 0.1, 0.1] * gas)
        )

    return Peer(name, "sh", "", gas, "", run, 1e-6, (folder,))
