# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameter files of a case for both solvers: parameters.lig (LIGGGHTS) and caseParameters (OpenFOAM)."""

from pathlib import Path

from bedchain.case.load import load_case
from bedchain.case.parameters import fluidization_line, liggghts_text, openfoam_text, solver_parameters
from bedchain.case.presets import preset_named, with_preset_bed
from bedchain.case.schema import load_schema
from bedchain.dem.disk import require_disk, run_bytes
from bedchain.dem.memory import require_memory
from bedchain.files import write_text


def write_parameters(case_file: Path, folder: Path, preset: str | None = None) -> None:
    """Check a case, the memory and the disk, then write both parameter files.

    Parameters
    ----------
    case_file : Path
        The case.
    folder : Path
        Gets ``parameters.lig`` and ``caseParameters``; made where missing. Equal files are left alone.
    preset : str, optional
        Whose bed it is; by default that of the case's key ``preset``, if any.

    Raises
    ------
    UserError
        Where the case cannot be run, or memory or disk do not hold it; nothing is written then.
    """
    case = load_case(case_file)
    if preset := preset or case.get("preset"):
        case = with_preset_bed(case, preset_named(preset))
    require_memory(case)
    parameters = solver_parameters(case, load_schema())
    folder.mkdir(parents=True, exist_ok=True)
    require_disk(folder, run_bytes(case))
    write_if_changed(folder / "parameters.lig", liggghts_text(parameters))
    write_if_changed(folder / "caseParameters", openfoam_text(parameters))
    if case["gas"]["model"] != "none":
        print(fluidization_line(case))


def write_if_changed(file: Path, text: str) -> None:
    """Write a text to a file, unless it is there already: its time stays then, and nothing runs again."""
    if file.exists() and file.read_text(encoding="utf-8") == text:
        return
    write_text(file, text)
