# SPDX-License-Identifier: GPL-3.0-or-later
"""The last lines of a run in which a stage failed, and its exit code."""

import json

import numpy as np

from made.workflow import linked, snakemake


def test_the_last_lines_of_a_failed_run_are_the_cause_and_the_way_on(tmp_path):
    folder = linked(tmp_path)
    (folder / "results/short").mkdir(parents=True)
    np.save(folder / "results/short/trajectory.npy", np.zeros((2, 3)))
    (folder / "results/short/trajectory.json").write_text(json.dumps({}))
    done = snakemake(folder, "--allowed-rules", "assign_cells", "--", "results/short/cells.npz")
    assert done.returncode == 1
    *_, empty, failed, sentence, log, way = done.stderr.splitlines()
    assert (empty, failed) == ("", "Failed: assign_cells of short")
    assert sentence.startswith("  ") and log == "  Its log: logs/short/assign_cells.log"
    assert sentence.strip() in (folder / "logs/short/assign_cells.log").read_text()
    assert way.startswith("To go on: mend the cause, then give the same command again")
