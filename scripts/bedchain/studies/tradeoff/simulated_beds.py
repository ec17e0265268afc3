# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate variants of a bed, some side by side, and measure cost and errors of each."""

import logging
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any, TypeVar

from bedchain.case.schema import Case
from bedchain.case.variants import Variant
from bedchain.dem.series import read_series
from bedchain.dem.variant_run import simulate
from bedchain.errors import UserError
from bedchain.files import write_text
from bedchain.meter import peak_memory_mb
from bedchain.studies.tradeoff.bed_variants import REALISATION, BedVariant
from bedchain.studies.tradeoff.observables import Reference, Seen, seen_errors
from bedchain.studies.tradeoff.reference import curves_seen, densities_seen, scalars_seen
from bedchain.trajectory.realisations import Realisation, open_realisation
from bedchain.trajectory.store import read_manifest, write_trajectory

LOG = logging.getLogger(__name__)

Made = TypeVar("Made")
Row = dict[str, Any]

HALF = "dem"
SOLVERS = ("bedFoam", "liggghts")
# the peak is kept by the system: it has to be read once before a solver ends
LOOK_EVERY_S = 0.5
PEAK_FILE = "peak_memory_mb"


def simulate_all(
    case_file: Path, wanted: Sequence[BedVariant], folder: Path, reference: Reference, at_once: int
) -> list[Row]:
    """Rows of all variants, in their order; one that fails is a row with its reason.

    Parameters
    ----------
    case_file : Path
        The case that they vary.
    wanted : sequence of BedVariant
    folder : Path
        Gets a folder for each of them, whose finished segments are taken up again after a stop.
    reference : Reference
        The run and its repeats; those variants that are further realisations of the same bed join them.
    at_once : int
        Variants side by side, on one rank each.

    Returns
    -------
    list of dict
        One a variant: what it is, cost, errors, ``problem`` (empty where all went well).
    """
    begun, rows, found = time.monotonic(), {}, {}
    with ThreadPoolExecutor(max_workers=at_once) as executor:
        jobs = {executor.submit(bed_row, case_file, one, folder / one.variant.name): one for one in wanted}
        try:
            for number, job in enumerate(as_completed(jobs), 1):
                name, (row, bed) = jobs[job].variant.name, job.result()
                rows[name] = row
                if bed:
                    found[name] = bed
                left_s = (time.monotonic() - begun) / number * (len(wanted) - number)
                said = row["problem"].splitlines()[0] if row["problem"] else f"{row['cost_s']:.0f} s"
                LOG.info("%d of %d beds, %s: %s; about %.0f s left", number, len(wanted), name, said, left_s)
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            raise
    alike = [one.variant.name for one in wanted if one.axis == REALISATION and one.variant.name in found]
    for name, bed in found.items():
        # nothing is compared with itself
        rows[name] |= seen_errors(reference.joined([found[other] for other in alike if other != name]), bed)
    return [rows[one.variant.name] for one in wanted]


def bed_row(case_file: Path, one: BedVariant, folder: Path) -> tuple[Row, Seen | None]:
    """Simulate one variant, or go on with it: what it is and cost, and what it did where all went well."""
    labels = {"half": HALF, "axis": one.axis, "variant": one.variant.name, "changed": one.changed}
    try:
        case, memory_mb = watched(
            lambda: simulate(case_file, on_one_rank(one.variant), folder), str(folder), folder / PEAK_FILE
        )
        wall_s = sum(part["wall_s"] for part in read_manifest(folder / "dem.json")["segments"])
        cost = {"run_s": wall_s, "cost_s": wall_s, "memory_mb": memory_mb}
        return labels | cost | {"problem": ""}, seen(folder, case)
    except UserError as error:
        return labels | {"problem": str(error)}, None


def on_one_rank(variant: Variant) -> Variant:
    """The variant, its gas cells not asked to share between ranks."""
    return Variant(variant.name, dict(variant.changes) | {"run.ranks": 1})


def seen(folder: Path, case: Case) -> Seen:
    """What a finished run did; its trajectory is not kept."""
    try:
        run = parsed(folder, case)
        scalars = scalars_seen(run, read_series(folder / "bed_series.csv"), case)
        return Seen(curves_seen(run, case), densities_seen(run, case), scalars)
    finally:
        for name in ("trajectory.npy", "trajectory.json"):
            (folder / name).unlink(missing_ok=True)


def parsed(folder: Path, case: Case) -> Realisation:
    """The frames of a run, in one file."""
    trajectory, metadata = folder / "trajectory.npy", folder / "trajectory.json"
    size = case["bed"]["width_m"], case["bed"]["height_m"]
    write_trajectory(folder / "dem.json", trajectory, metadata, *size, progress=False)
    return open_realisation(folder.name, trajectory, metadata)


def watched(work: Callable[[], Made], word: str, kept: Path) -> tuple[Made, float]:
    """What some work makes, and the peak memory of the solvers that it starts [MB].

    Parameters
    ----------
    work : callable
    word : str
        In the command lines of the solvers.
    kept : Path
        File that remembers the peak of earlier tries, which a finished run no longer shows.
    """
    peak, done = [float(kept.read_text()) if kept.exists() else 0.0], threading.Event()

    def look() -> None:
        while not done.wait(LOOK_EVERY_S):
            peak[0] = max(peak[0], solver_memory(word))

    watcher = threading.Thread(target=look, daemon=True)
    watcher.start()
    try:
        made = work()
    finally:
        done.set()
        watcher.join()
    if peak[0] > 0:
        write_text(kept, repr(peak[0]))
    return made, peak[0] if peak[0] > 0 else float("nan")


def solver_memory(word: str) -> float:
    """Largest peak of the running solvers with a word in their command line [MB]; 0 without any."""
    found = 0.0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_text(errors="replace")
            if word in command and Path(command.split("\0")[0]).name in SOLVERS:
                found = max(found, peak_memory_mb(process.name))
        except OSError:  # it has ended meanwhile
            continue
    return found
