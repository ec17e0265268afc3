# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimated cost of a case, and after a run its actual cost: results/<case>/estimate.csv, estimate.txt."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.presets import read_presets
from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.files import write_csv, write_text
from bedchain.stage import LOG, run_stage
from bedchain.studies.cost.actual import FACTOR_AIM, actual_cost, beside_actual, far_from_estimate
from bedchain.studies.cost.estimate import predicted
from bedchain.studies.cost.machine_speed import Speed, bed_of, calibrate
from bedchain.studies.cost.more_ranks import more_ranks
from bedchain.studies.expectation import expected_of
from bedchain.studies.expectation import lines as expected_lines
from bedchain.trajectory.store import BedFiles

UNITS = {"wall_s": "s", "memory_mb": "MB", "disk_mb": "MB on disk", "error_floors": "noise floors"}
SHOWN = {
    **{name: ("estimated", unit) for name, unit in UNITS.items()},
    **{f"happened_{name}": ("came true", unit) for name, unit in UNITS.items()},
    "done_1": ("share", "done"),
    "ratio_1": ("ratio", "of times"),
}
RANKS = {
    "fullest_slab_1": ("fullest slab", "over mean"),
    "twice_1": ("pairs", "twice"),
    "wall_s": ("the bed", "s"),
    "speedup_1": ("", "faster"),
}
FRAMES = 100  # of a bed that is there: enough for the mean of its fullest slab
BUSY_CORES = 0.5  # other programs that keep more of the machine busy are worth a word


def estimate_cost(
    case: Case, bed: str, benchmarks: dict[str, str], records: Iterable[str], archived: bool, presets: Path,
    table: Path, text: Path,
) -> None:  # fmt: skip
    """Estimate every stage of a case, and set what has happened beside it.

    Parameters
    ----------
    case : dict
        A checked case.
    bed : str
        Folder in ``results/`` where its particles are simulated.
    benchmarks : dict of str to str
        Folders of Snakemake's benchmarks by ``bed`` and ``made``.
    records : iterable of str
        Files of earlier runs; each ``dem.json`` of another case shows how fast this machine is.
    archived : bool
        Whether the bed is taken from an archive.
    presets : Path
        ``cases/presets.yaml``, for errors that were measured; it may be missing.
    table, text : Path
        Get the estimate, the second to be read.
    """
    results = Path("results") / bed
    runs = [Path(file) for file in records if Path(file).name == "dem.json"]
    speed = calibrate([run for run in runs if run.parent != results], bed_of(case))
    folders = {name: Path(folder) for name, folder in benchmarks.items()}
    expected = predicted(case, speed, read_presets(presets).values(), archived)
    found = beside_actual(expected, actual_cost(case, results, table.parent, folders))
    write_csv(found.reset_index(), table)
    ranks = on_more_ranks(case, speed, results) if "dem" in expected.index else []
    parts = [*header(case, speed.source, archived), lines(found), *ranks, *of_the_bed(case), ""]
    write_text(text, "\n".join(parts))
    for name in far_from_estimate(found):
        LOG.info(
            "%s came out %.2f times as long as estimated, more than %g",
            name,
            found["ratio_1"][name],
            FACTOR_AIM,
        )


def header(case: Case, source: str, archived: bool) -> list[str]:
    """What the estimate is of and rests on."""
    found = [f"{case['title']}, by {source}; stages one after the other, without figures and diagnostics"]
    if archived:
        found.append("the bed comes out of its archive; --config reference=simulate estimates its simulation")
    if (busy := os.getloadavg()[0]) > BUSY_CORES:
        found.append(
            f"other programs keep {busy:.1f} of {os.cpu_count()} cores busy now: it would take longer"
        )
    return found


def of_the_bed(case: Case) -> list[str]:
    """What to expect of the bed itself, by the two-phase model."""
    return expected_lines(expected_of(scene_of(case), case["mixing"]["split_z_m"]))


def on_more_ranks(case: Case, speed: Speed, results: Path) -> list[str]:
    """The simulation on more ranks than here, with its own slabs where the bed is there."""
    files = BedFiles(results / "trajectory.npy", results / "trajectory.json")
    x_m = None
    if files.trajectory.exists() and files.metadata.exists():
        store, described = files.open()
        later = store[np.searchsorted(described["times_s"], case["learning"]["start_s"]) :, 0]
        x_m = later[:: max(1, len(later) // FRAMES)] if len(later) else None
    table = more_ranks(case, speed, x_m)
    about = "spread evenly" if x_m is None else "as they are from the learning window on"
    return [
        f"on more ranks, each with a core like one of these, particles {about}; messages come on top",
        lines(table.set_index("ranks"), RANKS),
    ]


def lines(table: pd.DataFrame, shown: Mapping[str, tuple[str, str]] = SHOWN) -> str:
    """The table with short numbers, without columns of which nothing is known."""
    known = table.dropna(axis="columns", how="all")
    short = known.map(lambda value: "" if pd.isna(value) else f"{value:,.{0 if value >= 100 else 2}f}")
    short.columns = pd.MultiIndex.from_tuples([shown[name] for name in known.columns])
    return short.rename_axis(None).to_string()


if rule := globals().get("snakemake"):
    run_stage(estimate_cost, rule)
