# SPDX-License-Identifier: GPL-3.0-or-later
"""The two forms of a dump, as LIGGGHTS itself writes them in one run, on one rank and on two."""

import subprocess

import numpy as np
import pytest

from bedchain.trajectory.dumps import frame_of, read_dump
from made.synthetic_bed import COLUMNS

WIDTH, HEIGHT = 0.03, 0.05
# centres of five spheres of 1 mm, two of them in contact, on both halves of the box
PLACES = [(0.001, 0.001), (0.0025, 0.001), (0.021, 0.001), (0.0255, 0.001), (0.00252, 0.00199)]
# the text form has six significant digits
TEXT_PRECISION = 5e-6
DECK = """
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
processors * 1 1
region box block 0 {width} -0.001 0.001 0 {height} units box
create_box 1 box
neighbor 0.0005 bin
neigh_modify delay 0
fix young all property/global youngsModulus peratomtype 5e6
fix poisson all property/global poissonsRatio peratomtype 0.3
fix restitution all property/global coefficientRestitution peratomtypepair 1 0.9
fix friction all property/global coefficientFriction peratomtypepair 1 0.3
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix weight all gravity 9.81 vector 0 0 -1
fix bottom all wall/gran model hertz tangential history primitive type 1 zplane 0
fix integration all nve/sphere
{atoms}
set group all diameter 0.001 density 2600
dump binary all custom 100 frame_*.bin id x z vx vz
dump text all custom 100 frame_*.txt id x z vx vz
thermo 100
run 300
"""


@pytest.fixture(params=[1, 2], ids=["one_rank", "two_ranks"])
def folder(request, tmp_path):
    """Where LIGGGHTS has written four frames in both forms."""
    atoms = "\n".join(f"create_atoms 1 single {x} 0 {z} units box" for x, z in PLACES)
    (tmp_path / "in.box").write_text(DECK.format(width=WIDTH, height=HEIGHT, atoms=atoms))
    command = ["liggghts", "-in", "in.box"]
    if request.param > 1:
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(request.param), *command]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return tmp_path


@pytest.mark.parametrize("step", [0, 100, 300])
def test_both_forms_of_one_frame_agree(folder, step):
    ids, bounds = np.arange(1, len(PLACES) + 1), {"x": WIDTH, "z": HEIGHT}
    dumps = {form: read_dump(folder / f"frame_{step}.{form}", COLUMNS) for form in ("bin", "txt")}
    assert dumps["bin"].step == dumps["txt"].step == step
    np.testing.assert_allclose(dumps["bin"].box, dumps["txt"].box, rtol=TEXT_PRECISION)
    binary, text = (frame_of(dump, COLUMNS, ids, bounds) for dump in dumps.values())
    np.testing.assert_allclose(text, binary, rtol=TEXT_PRECISION, atol=1e-12)


def test_particles_fall_as_they_should(folder):
    frame = frame_of(read_dump(folder / "frame_100.bin", COLUMNS), COLUMNS, None, {"x": WIDTH, "z": HEIGHT})
    np.testing.assert_array_equal(frame[0], np.arange(1, len(PLACES) + 1))
    # 1 ms of free fall, for those that touch nothing yet
    np.testing.assert_allclose(frame[4, [0, 2, 3]], -9.81e-3, rtol=1e-9)
    # the second sphere is under the fifth, which overlaps it and pushes it down
    assert frame[4, 1] < -9.81e-3 < frame[4, 4]
