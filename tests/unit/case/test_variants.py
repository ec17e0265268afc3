# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a case: the changed keys and no others."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.variants import Variant, write_variant
from bedchain.errors import CaseError
from made.case_text import CASE, changed_case


def test_a_variant_differs_in_its_keys_only(tmp_path):
    file = changed_case(tmp_path)
    changes = {"gas.drag_law": "beetstra", "particles.number": 7000, "title": "another"}
    case, variant = load_case(file), write_variant(file, Variant("other", changes), tmp_path / "other")
    assert variant == load_case(tmp_path / "other" / "case.yaml")
    case["gas"]["drag_law"], case["particles"]["number"], case["title"] = changes.values()
    assert variant == case
    assert file.read_text() == CASE


def test_a_variant_that_cannot_run_is_refused_by_its_key(tmp_path):
    with pytest.raises(CaseError, match="gas.drag: is an unknown key; did you mean drag_law"):
        write_variant(changed_case(tmp_path), Variant("wrong", {"gas.drag": "x"}), tmp_path / "wrong")
