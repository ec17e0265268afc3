# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks by place and by property, files of ids, and separation by hand."""

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.measures.marks import Mark, read_ids, separation, variation_limits
from bedchain.trajectory.coordinates import Size
from bedchain.trajectory.particles import Particles

BED = Size(0.2, 0.4, 0.2)
KNOWN = Particles(np.array([3, 5, 8]), np.array([1, 2, 1], np.int32), np.float32([1e-3, 2e-3, 1e-3]))
X, Z, Y = np.array([0.01, 0.1, 0.19]), np.array([0.1, 0.2, 0.3]), np.array([0.1, 0.1, 0.1])


@pytest.mark.parametrize(
    ("mark", "expected"),
    [
        (Mark("a", plane={"normal": [1, 0, 0], "offset_m": 0.1}), [True, False, False]),
        (Mark("a", plane={"normal": [0, 0, -1], "offset_m": -0.15}), [False, True, True]),
        (Mark("a", ring={"radius_m": 0.05}), [False, True, False]),
        (Mark("a", ring={"radius_m": 0.05, "axis": "horizontal"}), [False, True, False]),
    ],
)
def test_a_place_marks_what_is_there(mark, expected):
    assert not mark.lasts
    assert mark.region(BED)(X, Z, Y).tolist() == expected


def test_types_sizes_and_ids_mark_particles(tmp_path):
    (tmp_path / "dyed.txt").write_text("8\n3\n")
    marks = [Mark("a", types=[1]), Mark("a", diameter_below_m=3e-3), Mark("a", ids="dyed.txt")]
    for mark in marks:
        assert mark.lasts and mark.of_particles(KNOWN, tmp_path).tolist() == [True, False, True]
    without = Particles(KNOWN.ids)
    for mark, word in zip(marks, ("types", "radii"), strict=False):
        with pytest.raises(UserError, match=f"a needs {word} of the particles"):
            mark.of_particles(without)
    with pytest.raises(UserError, match="needs ids of the particles"):
        marks[2].of_particles(None)


def test_bad_files_of_ids_are_refused(tmp_path):
    file = tmp_path / "ids.txt"
    with pytest.raises(UserError, match="no readable file of ids"):
        read_ids(file)
    for text, message in (("", "holds no ids"), ("3\nx\n", "line 2: 'x' is no id"), ("9" * 30, "is no id")):
        file.write_text(text)
        with pytest.raises(UserError, match=message):
            read_ids(file)
    file.write_text("3 99")
    with pytest.raises(UserError, match="id 99 of ids.txt is no particle of the bed"):
        Mark("a", ids="ids.txt").of_particles(KNOWN, tmp_path)


def test_separated_and_mixed_particles_by_hand():
    heights = np.array([0.1, 0.3])
    index, variation, high = separation(np.array([10, 0]), np.array([10, 10]), heights)
    assert (index, variation) == (0, 1) and high == pytest.approx(-1)
    index, variation, high = separation(np.array([5, 5]), np.array([10, 10]), heights)
    assert variation == 0 and high == 0 and index > 1  # more even than chance
    assert variation_limits(np.array([10, 10]), 0.5) == pytest.approx((1, np.sqrt(0.1)))
    assert np.isnan(separation(np.array([10, 10]), np.array([10, 10]), heights)).all()


def test_a_random_mixture_has_the_expected_index_and_variation():
    rng, cells = np.random.default_rng(6), np.repeat(np.arange(20), 30)
    total, values = np.full(20, 30), []
    for _ in range(400):
        marked = rng.permutation(600) < 150
        values.append(separation(np.bincount(cells[marked], minlength=20), total, np.ones(20)))
    index, variation, _ = np.mean(values, axis=0)
    assert index == pytest.approx(1, abs=0.01)
    assert variation == pytest.approx(variation_limits(total, 0.25)[1], rel=0.05)
