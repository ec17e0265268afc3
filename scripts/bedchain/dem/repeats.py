# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeats of a bed: further realisations from a state of the main run with perturbed velocities."""

from pathlib import Path
from typing import Any

from bedchain.dem.gas_case import copy_last_state, redistribute
from bedchain.dem.processes import SILENCE_S, run_deck
from bedchain.dem.segments import RESTART, SegmentedRun
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import is_prime

DECK = "in.perturb"
PERTURBED = "perturbed"
# rms 0.003 m/s, 1 % of the particles' rms velocity in the short bed: the same particle of two repeats is a
# diameter apart after 0.08 s, its velocities are uncorrelated (below 1/e) after 0.6 s
KICK_M_S = 5e-3
# that ./run takes unless other words say so
CORES = 2
# so large that two repeats never take the same prime
SEED_SPACING = 1000
# range that LIGGGHTS accepts
SMALLEST_SEED, LARGEST_SEED = 10007, 2**31 - 1


def repeat_folder(case: Path, number: int) -> Path:
    """Folder of a repeat's results, ``results/<case>/repeats/<number>``."""
    return case / "repeats" / str(number)


def repeat_ranks(ranks: int, repeats: int) -> int:
    """MPI ranks of each repeat [1]: one where several repeats run side by side, so that no rank waits.

    Parameters
    ----------
    ranks : int
        MPI ranks of the run [1].
    repeats : int
        How many repeats the case has [1].
    """
    return 1 if repeats > 1 else ranks


def repeats_at_once(ranks: int, repeats: int) -> int:
    """Repeats that run side by side on the cores of ``./run`` [1].

    Parameters
    ----------
    ranks : int
        MPI ranks of each of them [1].
    repeats : int
        How many there are [1].
    """
    return max(1, min(repeats, CORES // ranks))


def kick_seed(seed: int, number: int) -> int:
    """Seed of a repeat's perturbation, a prime as LIGGGHTS demands.

    Parameters
    ----------
    seed : int
        Seed of the case.
    number : int
        Number of the repeat, from 1.
    """
    span = LARGEST_SEED - SEED_SPACING - SMALLEST_SEED
    wanted = SMALLEST_SEED + (seed + SEED_SPACING * number - SMALLEST_SEED) % span
    return next(prime for prime in range(wanted, LARGEST_SEED + 1) if is_prime(prime))


def segment_that_ends(manifest: dict[str, Any], time_s: float) -> Path:
    """Folder of the segment of a run that ends at a time.

    Parameters
    ----------
    manifest : dict
        Of the run, ``dem.json``.
    time_s : float
        End of the segment [s].

    Returns
    -------
    Path
        Folder, relative to that of ``dem.json``.

    Raises
    ------
    UserError
        No segment ends at that time.
    """
    ends = {float(segment["end_s"]): Path(segment["folder"]) for segment in manifest["segments"]}
    nearest = min(ends, key=lambda end: abs(end - time_s))
    if abs(nearest - time_s) > 0.5 * float(manifest["dem_step_s"]):
        raise UserError(
            f"no segment of the run ends at {time_s:g} s, where the repeats start (comparison.start_s): take "
            f"{nearest:g} s, the nearest end, or a time.segment_s that divides {time_s:g} s, and move "
            "the run's segments from there on away"
        )
    return ends[nearest]


def perturb(
    run: SegmentedRun, segment: Path, target: Path, decks: Path, seed: int, speed_m_s: float = KICK_M_S
) -> None:
    """Write a perturbed copy of a segment's last state, of particles and gas, as the origin of a repeat.

    The segment may come from a run on another number of ranks.

    Parameters
    ----------
    run : SegmentedRun
        The repeat.
    segment : Path
        Folder with ``particles.restart`` and ``gas``.
    target : Path
        Folder that gets the same.
    decks : Path
        Folder of ``in.perturb``.
    seed : int
        A prime above 10000.
    speed_m_s : float
        Largest change of a velocity along x and along z, uniformly distributed [m/s].
    """
    copy_last_state(segment / "gas", target / "gas")
    redistribute(target / "gas", segment / "gas", run.ranks)
    variables = {
        "decks": decks,
        "parameters": run.case / "parameters.lig",
        "restart": segment / RESTART,
        "output": target,
        "kick_seed": seed,
        "kick_speed": speed_m_s,
    }
    run_deck(decks / DECK, variables, target / "liggghts.log", run.ranks, SILENCE_S)
