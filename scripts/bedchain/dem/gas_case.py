# SPDX-License-Identifier: GPL-3.0-or-later
"""The OpenFOAM case of a segment: a new mesh, or the mesh and the last fields of what it goes on from."""

import re
import shutil
from pathlib import Path

from bedchain.dem.processes import run_logged

GAS_CASE = Path("openfoam_case")
GAS_PARTS = ("0.orig", "constant", "system")


def prepare_gas(gas: Path, parameters: Path, previous: Path, settings: dict[str, object]) -> None:
    """Make the OpenFOAM case of a segment.

    Parameters
    ----------
    gas : Path
        Folder to make.
    parameters : Path
        ``caseParameters``.
    previous : Path
        What the segment goes on from: its folder ``gas`` gives mesh and fields; without one all is new.
    settings : dict
        Entries of ``segmentParameters``.
    """
    if (previous / "gas").exists():
        copy_last_state(previous / "gas", gas)
    else:
        for name in ["constant", "system"]:
            shutil.copytree(GAS_CASE / name, gas / name)
        shutil.copytree(GAS_CASE / "0.orig", gas / "0")
    shutil.copy(parameters, gas / "caseParameters")
    lines = (
        f'{name} "{value}";\n' if isinstance(value, str) else f"{name} {value};\n"
        for name, value in settings.items()
    )
    (gas / "segmentParameters").write_text("".join(lines), encoding="utf-8")
    if not (previous / "gas").exists():
        run_logged(["blockMesh", "-case", str(gas)], gas / "mesh.log")
        if settings["ranks"] != 1:
            run_logged(["decomposePar", "-case", str(gas)], gas / "mesh.log")


def copy_last_state(source: Path, target: Path) -> None:
    """Copy mesh, settings and the last fields of an OpenFOAM case, whole or cut for several ranks.

    Parameters
    ----------
    source : Path
        The case.
    target : Path
        Folder to make.
    """
    for name in ["constant", "system"]:
        shutil.copytree(source / name, target / name)
    for part in [source, *source.glob("processor*")]:
        last = last_time(part)
        if last is not None:
            shutil.copytree(last, target / last.relative_to(source))
        if part != source:
            shutil.copytree(part / "constant", target / part.name / "constant")


def cut_for_ranks(gas: Path, source: Path, ranks: int) -> None:
    """Put the last fields of a case together, or cut them, so that as many ranks can go on from them.

    Parameters
    ----------
    gas : Path
        Of `copy_last_state`; changed in place.
    source : Path
        The case that it was copied from.
    ranks : int
        MPI ranks.
    """
    parts = list(gas.glob("processor*"))
    if max(len(parts), 1) == ranks:
        return
    shutil.copy(source / "caseParameters", gas)
    settings = (source / "segmentParameters").read_text(encoding="utf-8")
    settings = re.sub(r"^ranks .*$", f"ranks {ranks};", settings, flags=re.MULTILINE)
    (gas / "segmentParameters").write_text(settings, encoding="utf-8")
    if parts:
        run_logged(["reconstructPar", "-case", str(gas), "-latestTime"], gas / "mesh.log")
        for part in parts:
            shutil.rmtree(part)
    if ranks > 1:
        run_logged(["decomposePar", "-case", str(gas), "-latestTime"], gas / "mesh.log")


def last_time(folder: Path) -> Path | None:
    """The latest time folder of an OpenFOAM case or of a rank's part of it."""
    times = [item for item in folder.iterdir() if item.is_dir() and re.fullmatch(r"[0-9.]+", item.name)]
    return max(times, key=lambda item: float(item.name), default=None)
