# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of a case file: defaults of the schema, checks, and one error with every problem."""

import difflib
import logging
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from bedchain.case.checks import physical_problems
from bedchain.case.chosen import AUTO
from bedchain.case.frame_checks import FRAMES, simulation_problems, with_measured
from bedchain.case.network_checks import NETWORK, bed_problems, network_schema
from bedchain.case.parcel_checks import narrow_cells
from bedchain.case.scene_checks import checked_keys
from bedchain.case.schema import SCHEMA_FILE, Case, Schema, case_value, load_schema, schema_keys
from bedchain.case.strict_yaml import Lines, read_yaml
from bedchain.case.two_fluid import is_two_fluid, particle_problems
from bedchain.errors import CaseError, Problem, UserError

LOG = logging.getLogger(__name__)
MOST_LETTERS = 60  # of a value in a message
NEW_NAMES = {"fidelity": "preset"}  # keys of a case and words of --config that were renamed


def load_case(
    file: Path | str, schema_file: Path = SCHEMA_FILE, measure: Callable[[Case, Path], Case] | None = None
) -> Case:
    """A case from its file, with defaults and checked.

    Parameters
    ----------
    file : path
        The case, as ``cases/case.schema.yaml`` describes it.
    schema_file : Path, optional
        The schema.
    measure : callable, optional
        Gives the sections that the frames of a case tell of, from the case as written and its folder.

    Returns
    -------
    dict
        Sections of keys, complete: ``case["bed"]["width_m"]``; int and float as the schema says.

    Raises
    ------
    CaseError
        The case has problems, all listed: unknown or missing keys, wrong values, impossible physics.
    UserError
        The file cannot be read.
    """
    file = Path(file)
    schema = load_schema(schema_file)
    data, lines = read_yaml(file)
    if not isinstance(data, dict):
        problem = Problem(
            "(file)", "holds no keys", f"start from cases/short/case.yaml, see {schema_file.name}"
        )
        raise CaseError(file, [problem])
    data = with_new_names(data, str(file))
    if data.get("cells") == AUTO:
        data["cells"] = {}
    if NETWORK in data:
        if problems := bed_problems(data, schema["properties"], lines):
            raise CaseError(file, problems)
        schema = network_schema(schema)
    elif FRAMES in data:
        data, schema = _with_frames(data, schema, lines, file, measure)
    elif is_two_fluid(data) and (problems := particle_problems(data, schema["properties"], lines)):
        raise CaseError(file, problems)
    errors = Draft202012Validator(schema).iter_errors(data)
    problems = list(dict.fromkeys(problem for error in errors for problem in _explain(error, schema, lines)))
    broken = {problem.key for problem in problems}
    case = _with_defaults(data, schema)
    _fill_derived_defaults(case, schema)
    problems += physical_problems(checked_keys(case), broken, lines)
    if problems:
        raise CaseError(file, sorted(problems, key=lambda problem: (problem.line or 0, problem.key)))
    if hint := narrow_cells(case):
        give_hint(f"{file}: {hint}")
    return case


def _with_frames(
    data: Case, schema: Schema, lines: Lines, file: Path, measure: Callable[[Case, Path], Case] | None
) -> tuple[Case, Schema]:
    """A case of frames with what they tell of, and the schema without what only a simulation needs."""
    problems = simulation_problems(data, lines)
    part = {"type": "object", "properties": {FRAMES: schema["properties"][FRAMES]}}
    for error in Draft202012Validator(part).iter_errors({FRAMES: data[FRAMES]}):
        problems += _explain(error, schema, lines)
    if problems:
        raise CaseError(file, problems)
    if measure is None:
        raise UserError(f"{file} is a case of frames: this needs a bed that is simulated")
    asked = dict(data) | {FRAMES: _with_defaults(data[FRAMES], schema["properties"][FRAMES])}
    needed = [name for name in schema["required"] if name != "seed"]
    return with_measured(asked, measure(asked, file.parent)), dict(schema) | {"required": needed}


def with_new_names(keys: Mapping[str, Any], place: str) -> dict[str, Any]:
    """Keys by their names of today; a renamed one is understood, with a hint in the log.

    Parameters
    ----------
    keys : mapping of str to value
        Of a case file, or the words of ``--config``.
    place : str
        Where they stand, for the hint.

    Returns
    -------
    dict of str to value
    """
    for old, new in NEW_NAMES.items():
        if old in keys and new not in keys:
            give_hint(f"{place}: {old} is now called {new}")
            keys = {new if key == old else key: value for key, value in keys.items()}
    return dict(keys)


@cache
def give_hint(message: str) -> None:
    """Log a hint, once in a process."""
    LOG.warning("hint: %s", message)


def _kind(schema: Schema) -> str | None:
    """Type of a value; of a number that may be `AUTO` that of the number."""
    kind = schema.get("type")
    return kind[0] if isinstance(kind, list) else kind


def _with_defaults(data: Any, schema: Schema) -> Any:
    if _kind(schema) == "integer" and isinstance(data, float) and data.is_integer():
        return int(data)
    if _kind(schema) == "number" and isinstance(data, int) and not isinstance(data, bool):
        return float(str(data))  # infinite beyond 1e308, which the schema refuses
    items = schema.get("items", {})
    if isinstance(data, list) and items.get("type") == "object":
        return [_with_defaults(item, items) for item in data]
    if schema.get("type") != "object" or not isinstance(data, dict):
        return data
    filled = dict(data)
    for name, part in schema.get("properties", {}).items():
        if name in data or "default" in part:
            filled[name] = _with_defaults(data.get(name, part.get("default")), part)
    return filled


def _fill_derived_defaults(case: Case, schema: Schema) -> None:
    for key, part in schema_keys(schema).items():
        section, _, name = key.rpartition(".")
        group = case_value(case, section) if section else case
        if "x-default-of" not in part or not isinstance(group, dict) or name in group:
            continue
        source = case_value(case, part["x-default-of"])
        if isinstance(source, int | float):
            group[name] = source * part.get("x-default-factor", 1)


def _explain(error: ValidationError, schema: Schema, lines: Lines) -> list[Problem]:
    path = _dotted(error.absolute_path)
    part: Any = error.schema
    given: Any = error.instance
    if error.validator == "additionalProperties":
        known = part["properties"]
        unknown = [name for name in given if name not in known]
        return [_unknown(_join(path, name), name, known, schema, lines) for name in unknown]
    if error.validator == "required":
        missing = [name for name in part["required"] if name not in given]
        return [_missing(_join(path, name), part["properties"][name], lines.get(path)) for name in missing]
    wrong, remedy = _wrong_value(error)
    line = lines.get(path, lines.get(path.split("[")[0]))
    return [Problem(path or "(file)", wrong, remedy, line)]


def _unknown(path: str, name: str, known: Schema, schema: Schema, lines: Lines) -> Problem:
    everywhere = {key.rpartition(".")[2]: key for key in schema_keys(schema)}
    if near := difflib.get_close_matches(name, known, 1):
        remedy = f"did you mean {near[0]}?"
    elif near := difflib.get_close_matches(name, everywhere, 1):
        remedy = f"did you mean {everywhere[near[0]]}?"
    else:
        remedy = f"known here: {', '.join(known)}"
    return Problem(path, "is an unknown key", remedy, lines.get(path))


def _missing(path: str, part: Schema, line: int | None) -> Problem:
    return Problem(path, "is missing", f"add it: {part['description']}", line)


DECIMAL = {
    "integer": "write an integer in decimal digits, such as 12",
    "number": "write it in decimal digits, such as 12, 0.5 or 1.5e-3",
}
LIMITS = {
    "minimum": "at least {}",
    "maximum": "at most {}",
    "exclusiveMinimum": "above {}",
    "exclusiveMaximum": "below {}",
    "enum": "one of {}",
    "type": "of the kind {}",
    "minItems": "a list of at least {}",
    "minLength": "a text of at least {} letter",
}


def _wrong_value(error: ValidationError) -> tuple[str, str]:
    part: Any = error.schema
    limit: Any = error.validator_value
    limit = ", ".join(map(str, limit)) if isinstance(limit, list) else limit
    rule = LIMITS.get(str(error.validator), "").format(limit)
    meaning = f" ({part['description']})" if "description" in part else ""
    if error.validator == "pattern" and isinstance(part["type"], list):
        remedy = f"{DECIMAL[part['type'][0]]}, or {AUTO}"
        return f"{error.instance!r} is not a number, and not {AUTO}", remedy + meaning
    if error.validator == "type" and (other := _other_kind(_kind(part), error.instance)):
        return other[0], other[1] + meaning
    if not rule:
        return error.message, f"see the schema{meaning}"
    return f"{_short(error.instance)} is not {rule}", f"give a value {rule}{meaning}"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= MOST_LETTERS else f"{text[:MOST_LETTERS]}... ({len(text)} characters)"


def _other_kind(wanted: str | None, value: Any) -> tuple[str, str] | None:
    """Fault and remedy of text where a number is expected, or of a number where text is."""
    if wanted in DECIMAL and isinstance(value, str):
        return f"{value!r} is not a number", DECIMAL[wanted]
    if wanted == "string" and isinstance(value, int | float) and not isinstance(value, bool):
        return f"{value} is not text", "put it in quotes"
    return None


def _join(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _dotted(path: Any) -> str:
    text = ""
    for part in path:
        text = f"{text}[{part}]" if isinstance(part, int) else _join(text, str(part))
    return text
