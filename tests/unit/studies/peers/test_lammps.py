# SPDX-License-Identifier: GPL-3.0-or-later
"""LAMMPS: its dashpot and its log."""

import pytest

from bedchain.errors import UserError
from bedchain.studies.peers import dpmfoam, lammps, liggghts
from made.peers import LAMMPS_LOG


def test_tangential_dashpot_is_the_root_of_the_stiffnesses():
    # G* = G / (2 (2 - nu)) and E* = E / (2 (1 - nu^2)), G = E / (2 (1 + nu))
    assert lammps.tangential_dashpot(0.3) ** 2 == pytest.approx(2 * 0.7 / 1.7)


def test_a_log_that_breaks_off_is_told(tmp_path):
    log = tmp_path / "log"
    log.write_text(LAMMPS_LOG.splitlines()[0])
    with pytest.raises(UserError, match="no finished run"):
        liggghts.loop_time(log)
    with pytest.raises(UserError, match="no table"):
        lammps.last_height(log)
    with pytest.raises(UserError, match="no pressure at the inlet"):
        dpmfoam.inlet_pressure(tmp_path)
