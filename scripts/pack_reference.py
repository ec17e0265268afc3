# SPDX-License-Identifier: GPL-3.0-or-later
"""Archive a simulated bed: what chains and figures need of it, in cases/<case>/reference/.

usage: python scripts/pack_reference.py paper

From a little before the learning to the end of the comparison: positions rounded down to whole levels, the
gas at the ends of the segments, the solver's series, the repeats' mixing curves, and where all of it is from.
"""

import argparse
import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.case.load import load_case
from bedchain.case.parameters import solver_parameters
from bedchain.case.schema import SCHEMA_FILE, Case, Schema, load_schema, schema_keys
from bedchain.dem.gas_field import read_gas_field
from bedchain.dem.repeats import kick_seed, repeat_folder
from bedchain.dem.segments import read_parameters
from bedchain.errors import UserError, report_user_errors
from bedchain.files import atomic_folder, write_arrays, write_csv, write_text
from bedchain.provenance import debian_packages, git_state, machine, python_packages
from bedchain.trajectory import archive
from bedchain.trajectory.frames import window
from bedchain.trajectory.packed_positions import levels_of, write_levels
from bedchain.trajectory.store import open_trajectory, read_manifest

# half a millimetre: in the short bed 1.15 bytes a particle and frame (1 mm: 0.92, 0.25 mm: 1.38). Velocities
# are differences over 50 ms, 59 mm/s off those of the moment; rounding adds 4 mm/s (1 mm: 8, 0.25 mm: 2)
LEVEL_M = 5e-4
# before the learning: chains that know where a particle came from start from it
HISTORY_S = 0.25
TIME_TOLERANCE_S = 1e-9


def pack_reference(case_file: Path, results: Path, target: Path, level_m: float = LEVEL_M) -> None:
    """Write the archive of a finished simulation, whole or not at all.

    Parameters
    ----------
    case_file : Path
        ``cases/<case>/case.yaml``.
    results : Path
        ``results/<case>``.
    target : Path
        Folder to make.
    level_m : float
        Positions are rounded down to multiples of it [m].

    Raises
    ------
    UserError
        There is an archive already, the simulation or a repeat is not finished, or the grid is finer.
    """
    case, schema = load_case(case_file), load_schema(SCHEMA_FILE)
    if target.exists():
        raise UserError(f"{target} is there: an archive is made once; move it away to make another")
    start_s, end_s = case["learning"]["start_s"], case["comparison"]["end_s"]
    manifest = finished_manifest(results, case)
    check_parameters(results, case, schema)
    store, described = open_trajectory(results / "trajectory.npy", results / "trajectory.json")
    history_s = min(HISTORY_S, start_s)
    frames = window(np.array(described["times_s"]), start_s - history_s, end_s)
    git = git_state()  # before files of the archive itself make the tree another one
    with atomic_folder(target) as part:
        levels = (levels_of(store[at, :2], level_m) for at in range(frames.start, frames.stop))
        write_levels(levels, part / archive.POSITIONS)
        shutil.copy(results / "bed_series.csv", part / archive.SERIES)
        numbers = range(1, case["comparison"]["repeats"] + 1)
        write_csv(repeat_curves(results, numbers), part / archive.REPEATS)
        write_arrays(part / archive.GAS, gas_moments(manifest, results, start_s, end_s))
        keys = archive.solver_keys(case, schema)
        provenance = {
            "solver_keys": keys,
            "solver_keys_sha256": archive.keys_hash(keys),
            "start_s": start_s,
            "end_s": end_s,
            "history_s": history_s,
            "n_frames": frames.stop - frames.start,
            "level_m": level_m,
            "steps": described["steps"][frames],
            "trajectory": {name: described[name] for name in ("ids", "number", "width_m", "height_m")},
            "dem": {name: value for name, value in manifest.items() if name != "frames"},
            "repeats": len(numbers),
            "seeds": {
                "particles": case["seed"],
                "repeats": [kick_seed(case["seed"], number) for number in numbers],
            },
            "git": git,
            "packages": {"debian": debian_packages(), "python": python_packages()},
            "machine": machine(),
            "files": {
                name: {"sha256": archive.file_hash(part / name), "bytes": (part / name).stat().st_size}
                for name in sorted((archive.POSITIONS, archive.SERIES, archive.REPEATS, archive.GAS))
            },
        }
        write_text(part / archive.PROVENANCE, json.dumps(provenance, indent=1) + "\n")
    try:
        archive.check_archive(target, case, schema)
    except UserError:
        shutil.rmtree(target)
        raise


def finished_manifest(results: Path, case: Case) -> dict[str, Any]:
    """Manifest of a run that has reached the end of the case.

    Raises
    ------
    UserError
        It is half simulated, or a repeat is missing.
    """
    manifest = read_manifest(results / "dem.json")
    last, end = manifest["frames"][-1]["time_s"], case["time"]["end_s"]
    if last < end - TIME_TOLERANCE_S:
        raise UserError(f"{results} is simulated up to {last:g} s of {end:g} s: let it finish first")
    for number in range(1, case["comparison"]["repeats"] + 1):
        file = repeat_folder(results, number) / "mixing.csv"
        if not file.exists():
            raise UserError(f"{file} is missing: run snakemake with --config reference=simulate first")
    return manifest


def check_parameters(results: Path, case: Case, schema: Schema) -> None:
    """Refuse results of a case that was edited since it was simulated.

    Raises
    ------
    UserError
        Names the keys whose values are others than those that the solvers got.
    """
    used = read_parameters(results / "parameters.lig")
    of_case = [part for part in solver_parameters(case, schema) if part.name in used]
    edited = [
        f"{part.source} is {part.value} and was {used[part.name]}"
        for part in of_case
        if part.source.split(",")[0] in schema_keys(schema) or part.name.startswith("gas_cells")
        if used[part.name] != part.value
    ]
    if edited:
        raise UserError(f"{results} is of another case: {'; '.join(edited)}; simulate it again")


def repeat_curves(results: Path, numbers: range) -> pd.DataFrame:
    """Mixing curves of all repeats, in the long form of mixing.csv."""
    tables = [pd.read_csv(repeat_folder(results, number) / "mixing.csv") for number in numbers]
    columns = ["time_s", "source", "direction", "group", "fraction_remaining_1"]
    return pd.concat(tables) if tables else pd.DataFrame(columns=columns)


def gas_moments(
    manifest: dict[str, Any], folder: Path, start_s: float, end_s: float
) -> dict[str, np.ndarray]:
    """Voidage and velocity of the gas at the ends of the segments in a window.

    Returns
    -------
    dict
        times_s (n_times,); x_m and z_m (n_gas_cells,), row by row; voidage [1], u_x and u_z [m/s]
        (n_times, n_gas_cells), in half precision.
    """
    cases = {
        segment["end_s"]: folder / segment["folder"] / "gas"
        for segment in manifest["segments"]
        if start_s - TIME_TOLERANCE_S <= segment["end_s"] <= end_s + TIME_TOLERANCE_S
    }
    moments = []
    for path in cases.values():
        voidage, velocity = read_gas_field(path, "voidage"), read_gas_field(path, "U")
        # cells of several ranks come one rank after the other
        order = np.lexsort((voidage.x_m, voidage.z_m))
        fields = (voidage.x_m, voidage.z_m, voidage.values, velocity.values[:, 0], velocity.values[:, 2])
        moments.append([field[order] for field in fields])
    x, z, *values = (np.array(field) for field in zip(*moments, strict=True))
    names = ("voidage", "u_x", "u_z")
    return {"times_s": np.array(list(cases)), "x_m": x[0], "z_m": z[0]} | {
        name: field.astype(np.float16) for name, field in zip(names, values, strict=True)
    }


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", help="name of the case")
    parser.add_argument(
        "--level", type=float, default=LEVEL_M, help="rounding of positions [m] (default 5e-4)"
    )
    given = parser.parse_args()
    folder = Path("cases") / given.case
    with report_user_errors():
        pack_reference(folder / "case.yaml", Path("results") / given.case, folder / "reference", given.level)
        files = sorted((folder / "reference").iterdir())
        print("\n".join(f"{file.stat().st_size / 1e6:8.2f} MB {file}" for file in files))


if __name__ == "__main__":
    main()
