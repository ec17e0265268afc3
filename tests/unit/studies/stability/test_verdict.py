# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdicts: guards in the solvers' words, the worst quantity, refused cases."""

import math

import pytest

from bedchain.errors import CaseError, Problem
from bedchain.studies.stability.verdict import (
    CRASHED,
    DIVERGED,
    INACCURATE,
    REFUSED,
    STABLE,
    judge,
    stopped,
)
from bedchain.studies.stability.verdict import refused as refused_verdict
from bedchain.studies.verification.rows import Row

END = "The last finished segment is intact: reduce"

SAID = {
    "overlap": "particle 12 at (0.001 0 0.002) m and the wall bottom overlap by 0.7 diameters, above "
    f"contact.largest_overlap_1 (0.5), at 0.01 s. {END}",
    "lost particle": f"particle 9 has left the bed (3 lost), last seen at (0.01 0 0.06) m, at 0.02 s. {END}",
    "voidage": f"voidage 0.1 in the gas cell at (0.0025 0 0.0075) m, below it (2 cells), at 0 s. {END}",
    "pressure": "the pressure is not solved after 1000 iterations (residual 1 before, 2 after), largest "
    f"residual 3 in the gas cell at (0.0025 0 0.0075) m, at 0.5 s. {END}",
    "divergence": "the run has diverged (pressure drop nan Pa, kinetic energy inf J), fastest gas [m/s] nan "
    f"in the gas cell at (0.0025 0 0.0075) m, at 1e-05 s. {END}",
}


@pytest.mark.parametrize("guard", SAID)
def test_the_solvers_own_words_tell_guard_place_and_time(guard):
    found = stopped(f"run_dem: settling\nerror: bedFoam ended with code 1:\n  --> FATAL :\n{SAID[guard]} it")
    assert (found.outcome, found.guard) == (DIVERGED, guard)
    assert found.x_m > 0 and found.z_m > 0 and found.time_s >= 0
    assert "intact" not in found.reason and found.reason.endswith("s.")


def test_particles_lost_while_they_settle_are_a_stop_too():
    found = stopped("ERROR: Lost atoms: original 64 current 61 (thermo.cpp:480)")
    assert (found.outcome, found.guard) == (DIVERGED, "lost particle while settling")
    assert math.isnan(found.time_s)


def test_an_end_that_no_guard_explains_is_a_fault_of_ours():
    assert stopped("bedFoam ended with code -11: its whole log: x").outcome == CRASHED
    assert stopped(f"Traceback (most recent call last): {SAID['overlap']}").outcome == CRASHED


def test_the_worst_quantity_decides_and_a_nan_is_never_stable():
    good, bad = Row("a [1]", 1.01, 1, 0.05, "x"), Row("b [1]", 0.3, 0, 0.1, "x")
    assert judge([good]).outcome == STABLE
    found = judge([good, bad])
    assert (found.outcome, found.quantity, found.value) == (INACCURATE, "b [1]", 0.3)
    assert judge([good, Row("c [1]", math.nan, 0, 0.1, "x"), bad]).quantity == "c [1]"
    assert judge([Row("d [1]", 1.0, math.nan, 0.1, "x")]).outcome == INACCURATE


def test_a_refused_case_tells_its_keys():
    problems = [Problem("gas.cell_size_m", "0.1 m is too large", "take 0.01"), Problem("a.b", "no", "yes")]
    found = refused_verdict(CaseError("case.yaml", problems))
    assert (found.outcome, found.guard) == (REFUSED, "check of gas.cell_size_m")
    assert "0.1 m is too large" in found.reason and "a.b" in found.reason
