# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a DEM run: each ends in a restart of both solvers, and exists complete or not at all.

A segment is written into a folder ``<name>.part`` and renamed when it is complete, so that a killed run
continues after its last finished segment. The start of a segment computes one force anew, and a fluidized bed
is chaotic: ``segment_s`` and the number of ranks pick another realisation of the same bed, without bias.
"""

import hashlib
import json
import re
from dataclasses import asdict, dataclass
from pathlib import Path

from bedchain.errors import UserError
from bedchain.files import path_inside

STAMP_DIGITS = 12  # of sha256: two sets of inputs never share a folder
SETTLED = "settled"
RESTART = "particles.restart"
RECORD = "segment.json"
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
    """

    index: int
    start_step: int
    end_step: int
    folder: str
    wall_s: float
    dem_s: float
    exchange_s: float
    gas_s: float


def input_stamp(files: list[Path], ranks: int, numbers: str = "") -> str:
    """Name of a set of inputs: equal bytes in equal order on equally many ranks give the same run.

    Parameters
    ----------
    files : list of Path
        Inputs of the run.
    ranks : int
        MPI ranks.
    numbers : str
        Other inputs, as text.
    """
    digest = hashlib.sha256(f"{ranks} ranks{numbers}".encode())
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


def frame_columns(parameters: dict[str, float | str]) -> list[str]:
    """Columns of the frames that ``in.fluidize`` writes, by the parameters of `read_parameters`."""
    return COLUMNS[int(parameters["depth_walls"])]


def finished_segments(folder: Path) -> list[Segment]:
    """Finished segments of a run, in order, up to the first missing one.

    Raises
    ------
    DataError
        A record names a folder outside the run's.
    """
    segments: list[Segment] = []
    while True:
        record = folder / f"segment_{len(segments) + 1:04d}" / RECORD
        if not record.exists():
            return segments
        segment = Segment(**json.loads(record.read_text(encoding="utf-8")))
        path_inside(folder, segment.folder)
        segments.append(segment)


def write_record(folder: Path, segment: Segment) -> None:
    """Write the record of a segment into its folder, which marks the segment as finished."""
    (folder / RECORD).write_text(json.dumps(asdict(segment), indent=1), encoding="utf-8")


def keep_own_frames(
    folder: Path, run: SegmentedRun, steps: tuple[int, int], frame_steps: int, suffix: str
) -> None:
    """Keep exactly the frames that a segment owns: after its start, up to its end, and the run's very first.

    A segment's first frame is the last one of the segment before; LIGGGHTS writes it again.

    Raises
    ------
    UserError
        Where a frame is missing or empty.
    """
    start, end = steps
    if start > run.start_step:
        (folder / f"frame_{start}.{suffix}").unlink(missing_ok=True)
        start += frame_steps
    for step in range(start, end + 1, frame_steps):
        frame = folder / f"frame_{step}.{suffix}"
        if not frame.exists() or frame.stat().st_size == 0:
            raise UserError(
                f"{frame} was not written: see the solver's log beside it, and check the disk's space"
            )


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
        file = state / owner.folder / f"frame_{step}.{parameters['dump_suffix']}"
        frames.append(
            {
                "step": step,
                "time_s": step * step_s,
                "file": str(file),
                "bytes": (run.results / file).stat().st_size,
            }
        )
    return {
        "stamp": run.stamp,
        "ranks": run.ranks,
        "dem_step_s": step_s,
        "frame_interval_s": frame_steps * step_s,
        "number": int(parameters["number"]),
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
            }
            for item in segments
        ],
    }
