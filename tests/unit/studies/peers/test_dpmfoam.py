# SPDX-License-Identifier: GPL-3.0-or-later
"""DPMFoam: its dashpot, its steps, its files and its log."""

import math
import re

import pytest

from bedchain.studies.peers import dpmfoam


def restitution_of(alpha):
    """Speed after over speed before of a Hertz impact with DPMFoam's dashpot, by small steps."""
    mass, stiffness, step = 1.0, 1.0, 1e-5
    overlap, speed = 0.0, 0.01
    start = speed
    while True:
        damping = alpha * math.sqrt(mass * stiffness) * max(overlap, 0.0) ** 0.25
        speed -= step * (stiffness * max(overlap, 0.0) ** 1.5 + damping * speed) / mass
        overlap += step * speed
        if overlap <= 0:
            return -speed / start


@pytest.mark.parametrize("restitution", [0.9, 0.6])
def test_the_dashpot_of_dpmfoam_gives_the_restitution(restitution):
    found = restitution_of(dpmfoam.dashpot(restitution))
    assert found == pytest.approx(restitution, rel=0.005)


def test_an_elastic_impact_has_no_dashpot():
    assert dpmfoam.dashpot(1.0) == 0


@pytest.mark.parametrize("fastest", [0.1, 1.0, 3.0])
def test_dpmfoams_rule_takes_the_step_of_the_bed(bed, fastest):
    # PairSpringSliderDashpot::nSubCycles of OpenFOAM 1912, written out
    young = 1.9e6 / (2 * (1 - 0.3**2))
    collision = 5.429675 * (1e-3 / 4) * (2600 / (young * math.sqrt(2 * fastest))) ** 0.4
    substeps = math.ceil(5e-4 / (collision / dpmfoam.resolution(bed, fastest)))
    assert substeps == 25


def test_dpmfoams_lines_give_sub_steps_and_times():
    report = dpmfoam.Report()
    for line in ["    25 move-collide subCycles\n", "ExecutionTime = 0.1 s  ClockTime = 1 s\n", "Time = 1\n"]:
        report(line)
    assert report.subcycles == [25] and len(report.ends) == 1


def test_the_cloud_names_the_cell_of_each_particle(bed, tmp_path):
    dpmfoam.write_cloud(bed, tmp_path)
    cloud = tmp_path / dpmfoam.CLOUD
    places = re.findall(r"^\((\S+) 0 (\S+)\) (\d+)$", (cloud / "positions").read_text(), re.M)
    # cells of 5 mm, 4 a row: columns 0, 1, 3 of rows 0, 1, 6
    assert [(float(x), float(z), int(cell)) for x, z, cell in places] == [
        (0.0005, 0.0005, 0),
        (0.0051, 0.0099, 5),
        (0.0195, 0.0305, 27),
    ]
    assert "(-0.3 0 0.4)" in (cloud / "U").read_text()
    assert "3(0 1 2)" in (cloud / "origId").read_text()
    assert "4{0}\n0()" in (cloud / "collisionRecordsPairData").read_text()
