# SPDX-License-Identifier: GPL-3.0-or-later
"""The last lines of a run in which a stage failed, and its exit code; in a folder with an odd name."""

import json
import sys
from pathlib import Path

import numpy as np

from made.workflow import ODD_NAME, linked, snakemake


def test_the_last_lines_of_a_failed_run_are_the_cause_and_the_way_on(tmp_path):
    """A script is found by a Python whose path has blanks and quotes, as in a clone in such a folder."""
    folder = linked(tmp_path / ODD_NAME)
    (folder / "my venv").symlink_to(Path(sys.executable).parents[1])
    (folder / "results/short").mkdir(parents=True)
    np.save(folder / "results/short/trajectory.npy", np.zeros((2, 3)))
    (folder / "results/short/trajectory.json").write_text(json.dumps({}))
    done = snakemake(
        folder,
        "--allowed-rules",
        "assign_cells",
        "--",
        "results/short/cells.npz",
        python=folder / "my venv/bin/python",
    )
    assert done.returncode == 1
    *_, empty, failed, sentence, log, way = done.stderr.splitlines()
    assert (empty, failed) == ("", "Failed: assign_cells of short")
    assert sentence.startswith("  ") and log == "  Its log: logs/short/assign_cells.log"
    assert sentence.strip() in (folder / "logs/short/assign_cells.log").read_text()
    assert way.startswith("To go on: mend the cause, then give the same command again")
