# SPDX-License-Identifier: GPL-3.0-or-later
"""A first case for frames of another program: cases/<name>/case.yaml.

usage: ./run import '/data/drum_*.vtk'
       ./run import 'run7/*.bin' --names id,x,y,z,vx,vy,vz --step_s 1e-5 --name seven

The files are only read. Without --step_s the step is estimated from the velocities, where there are any.
"""

import argparse
import re
from pathlib import Path

from bedchain.case.load import load_case
from bedchain.case.names import case_name_problem, is_name
from bedchain.case.presets import read_presets
from bedchain.errors import UserError, report_user_errors
from bedchain.files import write_text
from bedchain.trajectory.first_case import first_case
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.frame_files import FrameSettings
from bedchain.trajectory.frames_of_case import measured_sections
from bedchain.workflow import CASES, case_names


def write_case(pattern: str, name: str, settings: FrameSettings) -> Path:
    """Look at the frames and write the case.

    Parameters
    ----------
    pattern : str
        Of the files, relative to this folder or absolute.
    name : str
        Of the case.
    settings : FrameSettings
        With the absolute pattern.

    Returns
    -------
    Path
        The case file.

    Raises
    ------
    UserError
        The frames are of no use, or there is a case of this name.
    """
    file = CASES / name / "case.yaml"
    if file.exists():
        raise UserError(f"{file} is there already: give another name by --name")
    if problem := case_name_problem(name, [*case_names(), name], read_presets()):
        raise UserError(problem)
    case = first_case(settings, Path(), re.sub(r"[^\w .-]", "", Path(pattern).stem).strip() or name)
    for note in case.notes:
        print(f"note: {note}")
    write_text(file, case.text)
    try:
        cache = Path("results") / name / "frames.json"
        load_case(file, measure=lambda keys, folder: measured_sections(keys, folder, cache))
    except UserError as error:
        print(f"to be corrected by hand: {error}")
    print(f"{file} is written, read it; then: ./run --config case={name}")
    return file


def name_of(pattern: str) -> str:
    """Name of a case from the pattern of its files: letters of the file's name, else its folder's."""
    for part in (Path(pattern).name.split(".")[0], Path(pattern).parent.name):
        name = re.sub(r"[^A-Za-z0-9_-]+", "_", part).strip("_-")
        if name and is_name(name) and not name.isdigit():
            return name
    return "imported"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="./run import", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("pattern", help="of the files, in quotes")
    parser.add_argument("--name", help="of the case; by default from the name of the files")
    parser.add_argument("--step_s", type=float, help="time of a step of the code that wrote them [s]")
    parser.add_argument("--length_unit_m", type=float, default=1.0, help="0.001 where the files are in mm")
    parser.add_argument("--time_unit_s", type=float, default=1.0, help="0.001 where times are in ms")
    parser.add_argument("--names", help="of the columns, where the files have none: id,x,z")
    given = parser.parse_args()
    names = tuple(given.names.replace(" ", "").split(",")) if given.names else None
    with report_user_errors():
        pattern = str(Path(given.pattern).absolute())
        settings = FrameSettings(
            pattern, given.step_s, given.length_unit_m, given.time_unit_s, reading=FormSettings(names=names)
        )
        write_case(given.pattern, given.name or name_of(given.pattern), settings)


if __name__ == "__main__":
    main()
