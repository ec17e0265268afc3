# SPDX-License-Identifier: GPL-3.0-or-later
"""LIGGGHTS: its log."""

from bedchain.studies.peers import lammps, liggghts
from made.peers import LAMMPS_LOG, LIGGGHTS_LOG


def test_the_last_run_of_a_log_counts(tmp_path):
    log = tmp_path / "log"
    log.write_text(LIGGGHTS_LOG)
    assert liggghts.loop_time(log) == (1.5, 250, 9000)
    log.write_text(LAMMPS_LOG)
    assert liggghts.loop_time(log) == (6.45472, 2500, 9000)
    assert lammps.last_height(log) == 0.05601087419
