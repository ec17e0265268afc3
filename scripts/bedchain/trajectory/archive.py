# SPDX-License-Identifier: GPL-3.0-or-later
"""The archive of a simulated bed, cases/<case>/reference/: the names of its files, and its checks."""

import hashlib
import json
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from bedchain.case.chosen import AUTO
from bedchain.case.schema import Case, Schema, case_value, schema_keys
from bedchain.errors import UserError
from bedchain.files import path_inside, refuse_special_file
from bedchain.physics.whole_numbers import is_multiple, ratio

PROVENANCE = "provenance.json"
POSITIONS = "positions.xz"
SERIES = "bed_series.csv"
REPEATS = "repeats.csv"
GAS = "gas.npz"
# numbers that reach the solvers only through derived parameters
DERIVED = ("gas.cell_size_m", "time.frame_interval_s")
# of provenance.json, as far as it is read
NUMBER, COUNT, OBJECT = {"type": "number"}, {"type": "integer", "minimum": 0}, {"type": "object"}
SIZE = {"type": "number", "exclusiveMinimum": 0}
FILE = {"type": "object", "required": ["bytes", "sha256"], "properties": {"bytes": COUNT}}
KEYS = {
    "solver_keys": OBJECT,
    **dict.fromkeys(("start_s", "end_s", "history_s"), NUMBER),
    "level_m": SIZE,
    "n_frames": COUNT,
    "repeats": COUNT,
    "steps": {"type": "array", "items": COUNT},
    "trajectory": {"type": "object", "required": ["ids", "number", "width_m", "height_m"]},
    "dem": {"type": "object", "required": ["dem_step_s", "frame_interval_s"]},
    "files": {"type": "object", "additionalProperties": FILE},
}
LATER = {"steps", "trajectory", "dem"}  # of unpacking
FORM = {"type": "object", "required": sorted(KEYS.keys() - LATER), "properties": KEYS}
SIMULATE = "or simulate the bed: --config reference=simulate"


def solver_keys(case: Case, schema: Schema) -> dict[str, Any]:
    """Keys of a case that the simulation depends on.

    Parameters
    ----------
    case : dict
        A checked case.
    schema : dict
        Its schema.

    Returns
    -------
    dict
        Dotted key -> value.
    """
    keys = schema_keys(schema)
    return {key: case_value(case, key) for key in keys if "x-variable" in keys[key] or key in DERIVED}


def keys_hash(keys: dict[str, Any]) -> str:
    """SHA-256 of keys and values, independent of their order."""
    return hashlib.sha256(json.dumps(keys, sort_keys=True).encode()).hexdigest()


def file_hash(file: Path) -> str:
    """SHA-256 of a file's bytes."""
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_provenance(folder: Path) -> dict[str, Any]:
    """Provenance of an archive.

    Parameters
    ----------
    folder : Path
        ``cases/<case>/reference``.

    Raises
    ------
    UserError
        It is missing or cannot be read.
    """
    refuse_special_file(folder / PROVENANCE)
    try:
        provenance = json.loads((folder / PROVENANCE).read_text(encoding="utf-8"))
        Draft202012Validator(FORM).validate(provenance)
    except (OSError, ValueError, RecursionError, ValidationError) as error:
        reason = error.message if isinstance(error, ValidationError) else error
        raise UserError(
            f"{folder}: no readable archive of a bed ({reason}); fetch it again, {SIMULATE}"
        ) from error
    return dict(provenance)


def check_archive(folder: Path, case: Case, schema: Schema) -> dict[str, Any]:
    """Refuse an archive of another bed, or one that lacks frames or repeats that the case needs.

    Parameters
    ----------
    folder : Path
        ``cases/<case>/reference``.
    case : dict
        A checked case.
    schema : dict
        Its schema.

    Returns
    -------
    dict
        Provenance of the archive.

    Raises
    ------
    UserError
        The archive does not fit the case; the message lists every difference.
    """
    provenance = read_provenance(folder)
    wrong = [
        *_other_keys(provenance, case, schema),
        *_missing_times(provenance, case),
        *_uneven_lines(provenance, case),
    ]
    if wrong:
        lines = "\n".join(f"  {line}" for line in wrong)
        raise UserError(f"{folder} does not serve this case:\n{lines}\nchange the case, {SIMULATE}")
    return provenance


def _other_keys(provenance: dict[str, Any], case: Case, schema: Schema) -> list[str]:
    archived, parts = provenance["solver_keys"], schema_keys(schema)
    wrong = [
        f"{key} is {case_value(case, key)!r} and was {value!r} in the simulation: it is another bed"
        for key, value in archived.items()
        if case_value(case, key) != value
    ]
    # the default of a key that is newer than the archive is what the solvers did before it
    wrong += [
        f"{key} is {value!r}; the archive is older than this key, and has its default"
        for key, value in solver_keys(case, schema).items()
        if key not in archived and value != _default(parts[key], case)
    ]
    return wrong


def _default(part: Schema, case: Case) -> Any:
    if "x-default-of" in part:
        return case_value(case, part["x-default-of"]) * part.get("x-default-factor", 1)
    return part.get("default")


def _missing_times(provenance: dict[str, Any], case: Case) -> list[str]:
    start, end = provenance["start_s"], provenance["end_s"]
    wrong = [
        f"{name}.{edge} is {case[name][edge]:g} s, the archive holds {start:g} to {end:g} s"
        for name in ("learning", "comparison")
        for edge in ("start_s", "end_s")
        if not start <= case[name][edge] <= end
    ]
    interval = case["time"]["frame_interval_s"]
    frames = ratio(end, interval) - ratio(start, interval) + ratio(provenance["history_s"], interval) + 1
    if (n_frames := provenance["n_frames"]) != frames:
        wrong.append(f"it holds {n_frames} frames of {frames}: the simulation was not finished")
    if (archived := provenance["repeats"]) < (wanted := case["comparison"]["repeats"]):
        wrong.append(f"comparison.repeats is {wanted}, the archive holds {archived}")
    return wrong


def _uneven_lines(provenance: dict[str, Any], case: Case) -> list[str]:
    level = provenance["level_m"]
    bed, cells, mixing = case["bed"], case["cells"], case["mixing"]
    wrong = [
        f"cells.{name} {cells[name]}: {length:g} m in so many cells are no multiple of {level:g} m, to which "
        f"positions are rounded; take a divisor of {round(length / level)}"
        for name, length in (("columns", bed["width_m"]), ("rows", bed["height_m"]))
        if cells[name] != AUTO and ratio(length, level) % cells[name]
    ]
    wrong += [
        f"mixing.{name} is {mixing[name]:g} m, no multiple of {level:g} m, to which positions are rounded"
        for name in ("split_x_m", "split_z_m")
        if not is_multiple(mixing[name], level)
    ]
    return wrong


def check_files(folder: Path, provenance: dict[str, Any]) -> None:
    """Refuse files that differ by a byte from the archived ones.

    Parameters
    ----------
    folder : Path
    provenance : dict
        Of `read_provenance`.

    Raises
    ------
    UserError
        A file is missing, was changed, or is not within the folder; the first is named.
    """
    for name, expected in provenance["files"].items():
        file = path_inside(folder, name)
        remedy = f"fetch it again (git checkout -- {file}), {SIMULATE}"
        if not file.exists():
            raise UserError(f"{file} is missing: {remedy}")
        if file.stat().st_size != expected["bytes"]:
            raise UserError(f"{file} has {file.stat().st_size} bytes, {expected['bytes']} expected: {remedy}")
        if file_hash(file) != expected["sha256"]:
            raise UserError(f"{file} is corrupted, its checksum is not the archived one: {remedy}")
