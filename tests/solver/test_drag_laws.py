# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag laws, as the solver has them, against forces worked out apart and against their own limits."""

import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

HERE = Path(__file__).parent
LAWS = HERE.parents[1] / "openfoam_case/solver/bedFoam"
STOKES = 3 * np.pi * 1.8e-5 * 1e-3  # drag coefficient of a lone slow sphere of 1 mm [kg/s]
# force [N] on a sphere of 1 mm in air (1.2 kg/m3, 1.8e-5 Pa s) at a voidage and a superficial slip [m/s]
FORCES = [
    ("gidaspow", 0.4, 0.5, 4.369e-6),
    ("beetstra", 0.4, 0.5, 4.712e-6),
    ("di_felice", 0.4, 0.5, 4.116e-6),
    ("gidaspow", 0.4, 1.5, 2.342e-5),
    ("beetstra", 0.4, 1.5, 2.285e-5),
    ("di_felice", 0.4, 1.5, 2.292e-5),
    ("gidaspow", 0.5, 0.5, 2.513e-6),
    ("beetstra", 0.5, 0.5, 2.622e-6),
    ("di_felice", 0.5, 0.5, 2.084e-6),
]
FOUR_DIGITS = 3e-4
EDGE = (0.79999, 0.80001)  # where gidaspow changes from one law to the other


@pytest.fixture(scope="module")
def forces(tmp_path_factory):
    """Table of all laws: coefficient [kg/s] and force [N] by law, voidage and slip."""
    program = tmp_path_factory.mktemp("drag") / "drag_forces"
    sources = [str(HERE / "drag_forces.C"), str(LAWS / "dragLaws.C")]
    subprocess.run(["g++", "-std=c++14", f"-I{LAWS}", *sources, "-o", str(program)], check=True)
    lines = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout.splitlines()
    columns = ["law", "voidage", "slip", "coefficient", "force"]
    table = pd.DataFrame([line.split() for line in lines], columns=columns)
    return table.astype(dict.fromkeys(columns[1:], float)).set_index(columns[:3])


@pytest.mark.parametrize(("law", "voidage", "slip", "force"), FORCES)
def test_forces_worked_out_apart(forces, law, voidage, slip, force):
    assert forces.loc[(law, voidage, slip), "force"] == pytest.approx(force, rel=FOUR_DIGITS)


def test_a_lone_slow_particle_feels_stokes_drag(forces):
    slow = forces.xs((0.999, 1e-6), level=("voidage", "slip"))["coefficient"]
    # A thousandth of solids: Wen-Yu's factor is 1.003; the others' first correction goes with sqrt(solids)
    within = {
        "gidaspow": 0.005, "gidaspow_blend": 0.01, "wen_yu": 0.005, "beetstra": 0.06, "koch_hill": 0.08,
    }  # fmt: skip
    for law, tolerance in within.items():
        assert slow[law] == pytest.approx(STOKES, rel=tolerance)
    # Di Felice's coefficient is Dallavalle's, which is 4 % low at vanishing Re: (4.8)^2 / 24
    assert slow["di_felice"] == pytest.approx(STOKES * 4.8**2 / 24, rel=0.03)


def test_drag_at_rest_is_finite_and_grows_with_slip(forces):
    assert np.isfinite(forces["coefficient"]).all()
    for _, rows in forces.groupby(level=["law", "voidage"]):
        assert rows.sort_index(level="slip")["force"].is_monotonic_increasing


def test_gidaspow_is_ergun_below_and_wen_yu_above(forces):
    above = forces.xs(0.9, level="voidage")
    np.testing.assert_array_equal(above.loc["gidaspow"]["force"], above.loc["wen_yu"]["force"])
    below = forces.loc[("gidaspow", 0.7, 1.5), "force"]
    assert below != pytest.approx(forces.loc[("wen_yu", 0.7, 1.5), "force"], rel=0.01)


def test_the_blend_is_ergun_where_dense_and_wen_yu_where_dilute(forces):
    blend, sharp = (forces.loc[law]["force"] for law in ("gidaspow_blend", "gidaspow"))
    far = [0.4, 0.5, 0.9, 0.999]
    # The arc tangent leaves the other law 0.3 to 1.2 %; at 20 m/s in nearly empty gas Ergun's is four times
    # Wen-Yu's
    np.testing.assert_allclose(blend[far], sharp[far], rtol=0.05)
    assert blend[0.4, 0.5] == pytest.approx(sharp[0.4, 0.5], rel=2e-3)


def test_the_blend_does_not_jump(forces):
    below, above = (forces.xs(voidage, level="voidage")["force"].xs(1.5, level="slip") for voidage in EDGE)
    assert above["gidaspow_blend"] == pytest.approx(below["gidaspow_blend"], rel=0.005)
    assert below["gidaspow"] > 1.3 * above["gidaspow"]
    # Half of each law in the middle
    mean = (below["gidaspow"] + above["gidaspow"]) / 2
    assert below["gidaspow_blend"] == pytest.approx(mean, rel=0.005)
