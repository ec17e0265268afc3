# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a DEM run: each ends in a restart of both solvers, and exists complete or not at all.

A segment is written into a folder ``<name>.part`` and renamed when it is complete, so that a killed run
continues after its last finished segment. Its record, written last, holds size and hash of each of its files,
and of the state that it went on from: a segment whose files are others is made again.

A bed's segment goes on with the forces of the last step, which its restart keeps, so that it leaves the
course of one piece by round-off alone. A drum's start computes one force anew: LIGGGHTS has no command that
puts forces back. Either bed is chaotic: in the end ``segment_s`` and the number of ranks pick another
realisation of the same bed, without bias.
"""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from bedchain.errors import DataError, UserError
from bedchain.files import path_inside, write_text
from bedchain.fingerprints import check_fingerprint, fingerprint_of
from bedchain.trajectory.dumps import read_dump
from bedchain.trajectory.store import RECORD

STAMP_DIGITS = 12  # of sha256: two sets of inputs never share a folder
DECKS = Path("liggghts_inputs")
SETTLED = "settled"
RESTART = "particles.restart"
SERIES = "bed_series.csv"
COLUMNS = {0: ["id", "x", "z", "vx", "vz"], 1: ["id", "x", "y", "z", "vx", "vy", "vz"]}  # by depth_walls


@dataclass(frozen=True)
class SegmentedRun:
    """One simulation in segments.

    Attributes
    ----------
    case : Path
        ``results/<case>``, with ``parameters.lig`` and ``caseParameters``.
    results : Path
        Gets ``dem.json`` and ``bed_series.csv``: the same, or ``results/<case>/repeats/<N>``.
    stamp : str
        Of the inputs; the state is in ``dem/<stamp>`` of the results.
    ranks : int
        MPI ranks.
    start_step, end_step : int
        Steps of the particles.
    origin : str
        Folder of the state that the first segment goes on from.
    """

    case: Path
    results: Path
    stamp: str
    ranks: int
    start_step: int
    end_step: int
    origin: str

    @property
    def state(self) -> Path:
        """Folder of the origin and the segments."""
        return self.results / "dem" / self.stamp


@dataclass(frozen=True)
class Segment:
    """A finished segment.

    Attributes
    ----------
    index : int
        From 1.
    start_step, end_step : int
        Steps of the particles.
    folder : str
        Name of its folder.
    wall_s, dem_s, exchange_s, gas_s : float
        Wall time of the solver's loop, and its shares in particles, exchange and gas [s].
    follows : str
        Hash of the state that it went on from; empty in a record of an earlier version.
    files : dict of str to dict
        Fingerprint of each file by its path in the folder; empty in a record of an earlier version.
    cpu_s : float
        Processor time of the solver, all ranks together [s]; 0 in a record of an earlier version.
    """

    index: int
    start_step: int
    end_step: int
    folder: str
    wall_s: float
    dem_s: float
    exchange_s: float
    gas_s: float
    follows: str = ""
    files: dict[str, dict[str, Any]] = field(default_factory=dict)
    cpu_s: float = 0.0

    @property
    def state(self) -> str:
        """Hash of the state that it ends in: restart and gas, neither frames nor series."""
        others = ("frame_", SERIES, f"gas/{SERIES}")
        known = {name: value for name, value in self.files.items() if not name.startswith(others)}
        return hashlib.sha256(json.dumps(known, sort_keys=True).encode()).hexdigest() if known else ""


def input_stamp(files: list[Path], numbers: str = "") -> str:
    """Name of a set of inputs: equal bytes in equal order give the same run, on any number of ranks.

    Parameters
    ----------
    files : list of Path
        Inputs of the run.
    numbers : str
        Other inputs, as text.
    """
    digest = hashlib.sha256(numbers.encode())
    for file in files:
        digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:STAMP_DIGITS]


def read_parameters(file: Path) -> dict[str, float | str]:
    """Numbers and words of a LIGGGHTS include (``variable name equal value  # comment``).

    Raises
    ------
    UserError
        The file is missing.
    """
    if not file.exists():
        raise UserError(f"{file} is missing: run scripts/write_parameters.py first")
    variables = re.findall(
        r"^variable (\w+) (equal|string) (\S+)", file.read_text(encoding="utf-8"), re.MULTILINE
    )
    return {name: float(value) if style == "equal" else value for name, style, value in variables}


def frame_columns(parameters: Mapping[str, float | str]) -> list[str]:
    """Columns of the frames that ``in.fluidize`` writes, by the parameters of `read_parameters`."""
    return COLUMNS[int(parameters["depth_walls"])]


def finished(folder: Path, start_step: int | None = None, follows: str = "") -> Segment | None:
    """The finished segment, or the settled state, in a folder; None where the folder is not there.

    Sizes are compared of all its files, hashes of all but the frames: those are compared when they are read.

    Parameters
    ----------
    folder : Path
    start_step : int, optional
        Step that it must begin at.
    follows : str, optional
        Hash of the state that it must have gone on from; empty where that is not known.

    Raises
    ------
    DataError
        It is not what its maker left: names the file and what is wrong.
    """
    if not folder.exists():
        return None
    segment = _read_record(folder)
    if start_step is not None and segment.start_step != start_step:
        raise DataError(f"{folder} begins at step {segment.start_step}, not where the one before it ends")
    if follows and segment.follows and segment.follows != follows:
        raise DataError(f"{folder} did not go on from the state before it")
    for name, fingerprint in segment.files.items():
        check_fingerprint(path_inside(folder, name), fingerprint, with_hash=not name.startswith("frame_"))
    return segment if segment.files else replace(segment, files=fingerprints_in(folder))


def _read_record(folder: Path) -> Segment:
    record = folder / RECORD
    if not record.exists():
        raise DataError(f"{folder} has no record {RECORD}: it was left before it was complete")
    try:
        segment = Segment(**json.loads(record.read_text(encoding="utf-8")))
        numbers = (segment.index, segment.start_step, segment.end_step)
        whole = segment.folder == folder.name and all(isinstance(number, int) for number in numbers)
        whole = whole and all(
            {"bytes", "blake2b"} == fingerprint.keys() for fingerprint in segment.files.values()
        )
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise DataError(f"{record} cannot be read ({error})") from error
    if not whole:
        raise DataError(f"{record} is no record of {folder.name}")
    return segment


def fingerprints_in(folder: Path) -> dict[str, dict[str, Any]]:
    """Size and hash of all files in a segment's folder that a later step relies on, by name: not its logs."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    return {
        str(file.relative_to(folder)): fingerprint_of(file)
        for file in files
        if file.suffix != ".log" and file.name != RECORD
    }


def write_record(folder: Path, segment: Segment) -> Segment:
    """Write the record of a segment into its folder, which marks the segment as finished.

    Returns
    -------
    Segment
        With the fingerprints of all its files.
    """
    segment = replace(segment, files=fingerprints_in(folder))
    write_text(folder / RECORD, json.dumps(asdict(segment), indent=1))
    return segment


def keep_own_frames(
    folder: Path, run: SegmentedRun, steps: tuple[int, int], parameters: Mapping[str, float | str]
) -> None:
    """Keep exactly the frames that a segment owns: after its start, up to its end, and the run's very first.

    A segment's first frame is the last one of the segment before; LIGGGHTS writes it again.

    Raises
    ------
    UserError
        Where a frame is missing or not complete.
    """
    start, end = steps
    frame_steps, suffix = int(parameters["frame_steps"]), parameters["dump_suffix"]
    if start > run.start_step:
        (folder / f"frame_{start}.{suffix}").unlink(missing_ok=True)
        start += frame_steps
    for step in range(start, end + 1, frame_steps):
        frame = folder / f"frame_{step}.{suffix}"
        dump = read_dump(frame, frame_columns(parameters))
        if dump.step != step or len(dump.values) != int(parameters["number"]):
            raise DataError(f"{frame} holds {len(dump.values)} particles at step {dump.step}")


def manifest(run: SegmentedRun, segments: list[Segment]) -> dict[str, object]:
    """Content of ``dem.json``: all frames up to the end in order, and the segments that hold them.

    Parameters
    ----------
    run : SegmentedRun
    segments : list of Segment
        Up to the end of the run.
    """
    parameters = read_parameters(run.case / "parameters.lig")
    step_s, frame_steps = float(parameters["dem_step"]), int(parameters["frame_steps"])
    state = run.state.relative_to(run.results)
    frames = []
    for step in range(run.start_step, run.end_step + 1, frame_steps):
        owner = next(
            item
            for item in segments
            if item.start_step < step <= item.end_step or item.start_step == step == run.start_step
        )
        name = f"frame_{step}.{parameters['dump_suffix']}"
        place = {"step": step, "time_s": step * step_s, "file": str(state / owner.folder / name)}
        frames.append(place | owner.files[name])
    return {
        "stamp": run.stamp,
        "ranks": run.ranks,
        "dem_step_s": step_s,
        "frame_interval_s": frame_steps * step_s,
        "number": int(parameters["number"]),
        "particles_per_parcel": float(parameters.get("particles_per_parcel", 1.0)),
        "columns": frame_columns(parameters),
        "frames": frames,
        "segments": [
            {
                "index": item.index,
                "start_s": item.start_step * step_s,
                "end_s": item.end_step * step_s,
                "folder": str(state / item.folder),
                "wall_s": item.wall_s,
                "dem_s": item.dem_s,
                "exchange_s": item.exchange_s,
                "gas_s": item.gas_s,
                "cpu_s": item.cpu_s,
            }
            for item in segments
        ],
    }
