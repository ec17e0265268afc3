# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed simulated again beside its archive: which frames are the same, and how far the others are off.

usage: python scripts/check_reference.py paper
       python scripts/check_reference.py paper --results results/elsewhere

The same solver on the same machine and ranks makes the same frames to the last bit; on another machine the
first frames agree and the later ones in their statistics only, as two realisations of one bed do.
"""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.errors import UserError, report_user_errors
from bedchain.trajectory import archive
from bedchain.trajectory.packed_positions import levels_of, middle_of, read_levels
from bedchain.trajectory.store import open_trajectory


def check_reference(reference: Path, trajectory: Path, metadata: Path) -> pd.DataFrame:
    """Compare a simulated trajectory with the archived frames of the same times.

    Parameters
    ----------
    reference : Path
        ``cases/<case>/reference``.
    trajectory, metadata : Path
        ``trajectory.npy``, ``trajectory.json``.

    Returns
    -------
    DataFrame
        For each common frame: time_s, same_share_1 (of the particles, on the same levels),
        archived_height_m and simulated_height_m (means over the particles).

    Raises
    ------
    UserError
        No frame is of both, or they hold other particles.
    """
    found = archive.read_provenance(reference)
    archive.check_files(reference, found)
    store, described = open_trajectory(trajectory, metadata)
    number, level_m = found["trajectory"]["number"], found["level_m"]
    if described["number"] != number:
        raise UserError(f"{trajectory} holds {described['number']} particles, the archive {number}")
    at = {step: frame for frame, step in enumerate(described["steps"])}
    frames = read_levels(reference / archive.POSITIONS, found["n_frames"], number)
    rows = []
    for step, levels in zip(found["steps"], frames, strict=True):
        if step in at:
            simulated = store[at[step], :2]
            rows.append(
                {
                    "time_s": step * found["dem"]["dem_step_s"],
                    "same_share_1": (levels_of(simulated, level_m) == levels).all(axis=0).mean(),
                    "archived_height_m": middle_of(levels[1], level_m).mean(dtype=float),
                    "simulated_height_m": np.mean(simulated[1], dtype=float),
                }
            )
    if not rows:
        raise UserError(f"{trajectory} and {reference} have no frame in common: simulate further")
    return pd.DataFrame(rows)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", help="name of the case")
    parser.add_argument("--results", type=Path, help="folder of the simulated bed (default results/<case>)")
    given = parser.parse_args()
    folder = given.results or Path("results") / given.case
    with report_user_errors():
        reference = Path("cases") / given.case / "reference"
        table = check_reference(reference, folder / "trajectory.npy", folder / "trajectory.json")
        same = int((table["same_share_1"] == 1).cumprod().sum())
        off = (table["simulated_height_m"] - table["archived_height_m"]).abs().max()
        print(table.to_string(index=False, float_format="%.6g"))
        print(
            f"the first {same} of {len(table)} common frames are the same; mean heights differ by {off:.2g} m"
        )


if __name__ == "__main__":
    main()
