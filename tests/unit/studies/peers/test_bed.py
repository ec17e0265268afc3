# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed that all codes of the comparison get."""

import math

import pytest

from bedchain.errors import UserError
from bedchain.studies.peers.bed import fluidized_bed, with_numbers, write_inputs
from made import ROOT


def test_inputs_hold_the_bed_and_the_numbers_of_the_comparison(bed, tmp_path):
    write_inputs(bed, tmp_path / "case", frame_steps=50, dem_step=1e-5)
    given = (tmp_path / "case" / "parameters.lig").read_text()
    assert "variable dem_step equal 1e-05" in given and "variable frame_steps equal 50" in given
    assert given.count("dem_step") == 1
    assert "3 atoms" in (tmp_path / "case" / "particles.data").read_text()
    assert [item.value for item in with_numbers(bed.parameters, young=1.0) if item.name == "young"] == [1.0]


def test_weight_of_the_bed(bed):
    assert bed.weight_per_area == pytest.approx(3 * 2600 * math.pi / 6 * 1e-9 * 9.81 / 2e-5)


def test_a_thick_bed_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(UserError, match="bed.layers: the comparison runs beds of one layer"):
        fluidized_bed(ROOT / "cases/mueller/case.yaml", tmp_path, tmp_path / "bedFoam", 0.1)
