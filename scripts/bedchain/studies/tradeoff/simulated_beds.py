# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a bed: each simulated by itself, then their cost and errors."""

import json
import logging
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

from bedchain.case.load import load_case
from bedchain.case.schema import Case
from bedchain.case.variants import Variant
from bedchain.dem.series import read_series
from bedchain.dem.variant_run import simulate
from bedchain.errors import UserError
from bedchain.files import write_text
from bedchain.meter import peak_memory_mb
from bedchain.studies.tradeoff.bed_variants import REALISATION, BedVariant
from bedchain.studies.tradeoff.observables import BedObservables, Reference, bed_errors
from bedchain.studies.tradeoff.reference import window_curves, window_densities, window_scalars
from bedchain.trajectory.store import read_manifest
from bedchain.trajectory.stored_dumps import parsed_run

LOG = logging.getLogger(__name__)

Made = TypeVar("Made")
Row = dict[str, Any]

HALF = "dem"
SOLVERS = ("bedFoam", "liggghts")
# the peak is kept by the system: it has to be read once before a solver ends
LOOK_EVERY_S = 0.5
PEAK_FILE = "peak_memory_mb"
RECORD = "variant.json"


def simulate_bed(case_file: Path, bed: BedVariant, folder: Path) -> None:
    """Simulate a variant to its end or to the error that stops it, or go on with it; `RECORD` says which.

    Parameters
    ----------
    case_file : Path
        The case that it varies.
    bed : BedVariant
    folder : Path
        Of the variant; after a stop its finished segments are used again.
    """
    memory_mb, problem = float("nan"), ""
    try:
        _, memory_mb = watched(
            lambda: simulate(case_file, on_one_rank(bed.variant), folder), str(folder), folder / PEAK_FILE
        )
    except UserError as error:
        problem = str(error)
        LOG.warning("%s: %s", bed.variant.name, problem)
    folder.mkdir(parents=True, exist_ok=True)
    write_text(folder / RECORD, json.dumps({"problem": problem, "memory_mb": memory_mb}))


def measure_all(wanted: Sequence[BedVariant], folder: Path, reference: Reference) -> list[Row]:
    """Rows of variants that were simulated, in their order; one that failed has the reason in its row.

    Parameters
    ----------
    wanted : sequence of BedVariant
    folder : Path
        With a folder for each variant.
    reference : Reference
        Of the run and its repeats; variants that are realisations of the same bed join it.

    Returns
    -------
    list of dict
        One for each variant: labels, cost, errors, ``problem`` (empty without one).

    Raises
    ------
    UserError
        A variant is not simulated.
    """
    rows, beds = {}, {}
    for bed in wanted:
        name = bed.variant.name
        rows[name], observables = bed_row(bed, folder / name)
        if observables:
            beds[name] = observables
    alike = [bed.variant.name for bed in wanted if bed.axis == REALISATION and bed.variant.name in beds]
    for name, observables in beds.items():
        # no bed is compared with itself
        others = [beds[other] for other in alike if other != name]
        rows[name] |= bed_errors(reference.joined(others), observables)
    return list(rows.values())


def bed_row(bed: BedVariant, folder: Path) -> tuple[Row, BedObservables | None]:
    """Row of a variant that was simulated, and its observables (None where it failed)."""
    if not (folder / RECORD).exists():
        raise UserError(f"{folder} is not simulated: scripts/run_variant.py, or ./run tradeoff, does it")
    record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
    labels = {"half": HALF, "axis": bed.axis, "variant": bed.variant.name, "changed": bed.changed}
    if record["problem"]:
        return labels | {"problem": record["problem"]}, None
    segments = read_manifest(folder / "dem.json")["segments"]
    wall_s, cpu_s = (sum(part.get(name, 0.0) for part in segments) for name in ("wall_s", "cpu_s"))
    # on one rank; other work on the machine lengthens the wall time only
    cost = {"run_s": wall_s, "cost_s": cpu_s or wall_s, "memory_mb": record["memory_mb"]}
    return labels | cost | {"problem": ""}, bed_observables(folder, load_case(folder / "case.yaml"))


def on_one_rank(variant: Variant) -> Variant:
    """The variant on one rank, so that its gas cells need not divide between ranks."""
    return Variant(variant.name, dict(variant.changes) | {"run.ranks": 1})


def bed_observables(folder: Path, case: Case) -> BedObservables:
    """Observables of a finished run."""
    with parsed_run(folder, case["bed"]["width_m"], case["bed"]["height_m"]) as run:
        scalars = window_scalars(run, read_series(folder / "bed_series.csv"), case)
        return BedObservables(window_curves(run, case), window_densities(run, case), scalars)


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
