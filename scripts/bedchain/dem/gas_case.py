# SPDX-License-Identifier: GPL-3.0-or-later
"""The OpenFOAM case of a segment: new, or with the mesh and last fields of the segment before."""

import re
import shutil
from pathlib import Path

from bedchain.dem.processes import run_logged

GAS_CASE = Path("openfoam_case")
GAS_PARTS = ("0.orig", "constant", "system")


def prepare_gas(gas: Path, parameters: Path, previous: Path, settings: dict[str, object]) -> None:
    """Write the OpenFOAM case of a segment.

    Parameters
    ----------
    gas : Path
        Folder to write.
    parameters : Path
        ``caseParameters``.
    previous : Path
        State that the segment continues: mesh and fields of its folder ``gas``; new ones where it has none.
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
    ranks = int(str(settings["ranks"]))
    if (previous / "gas").exists():
        cut_anew(gas, ranks)
        return
    run_logged(["blockMesh", "-case", str(gas)], gas / "mesh.log")
    if ranks > 1:
        run_logged(["decomposePar", "-case", str(gas)], gas / "mesh.log")


def copy_last_state(source: Path, target: Path) -> None:
    """Copy mesh, settings and the last fields of an OpenFOAM case, for one rank or decomposed.

    Parameters
    ----------
    source : Path
        The case.
    target : Path
        Folder to write.
    """
    for name in ["constant", "system"]:
        shutil.copytree(source / name, target / name)
    for part in [source, *source.glob("processor*")]:
        last = last_time(part)
        if last is not None:
            shutil.copytree(last, target / last.relative_to(source))
        if part != source:
            shutil.copytree(part / "constant", target / part.name / "constant")


def redistribute(gas: Path, source: Path, ranks: int) -> None:
    """Reconstruct or decompose the last fields of a case, so that another number of ranks can continue it.

    Parameters
    ----------
    gas : Path
        Case of `copy_last_state`; changed in place.
    source : Path
        The case that it was copied from.
    ranks : int
        MPI ranks.
    """
    if cut_in(gas) == ranks:
        return
    shutil.copy(source / "caseParameters", gas)
    settings = (source / "segmentParameters").read_text(encoding="utf-8")
    settings = re.sub(r"^ranks .*$", f"ranks {ranks};", settings, flags=re.MULTILINE)
    (gas / "segmentParameters").write_text(settings, encoding="utf-8")
    cut_anew(gas, ranks)


def cut_in(gas: Path) -> int:
    """Parts that the last fields of a case are cut into, one for each MPI rank that wrote them [1]."""
    return max(1, len(list(gas.glob("processor*"))))


def cut_anew(gas: Path, ranks: int) -> None:
    """Put the last fields of a case together and cut them for other ranks, by its ``segmentParameters``."""
    if cut_in(gas) == ranks:
        return
    if parts := list(gas.glob("processor*")):
        run_logged(["reconstructPar", "-case", str(gas), "-latestTime"], gas / "mesh.log")
        for part in parts:
            shutil.rmtree(part)
    if ranks > 1:
        run_logged(["decomposePar", "-case", str(gas), "-latestTime"], gas / "mesh.log")


def last_time(folder: Path) -> Path | None:
    """The latest time folder of an OpenFOAM case or of a rank's part, None without any."""
    times = [item for item in folder.iterdir() if item.is_dir() and re.fullmatch(r"[0-9.]+", item.name)]
    return max(times, key=lambda item: float(item.name), default=None)
