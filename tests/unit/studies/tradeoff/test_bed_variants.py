# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a simulated bed: all are cases, chosen by name."""

from pathlib import Path

import pytest

from bedchain.case.bed_checks import RAYLEIGH_SHARE_MAX
from bedchain.case.load import load_case
from bedchain.case.variants import write_variant
from bedchain.errors import UserError
from bedchain.physics.contacts import rayleigh_time
from bedchain.physics.whole_numbers import is_multiple
from bedchain.studies.tradeoff.bed_variants import bed_variants, variants_or_exit, wanted_variants
from bedchain.studies.tradeoff.simulated_beds import on_one_rank

SHORT = Path("cases/short/case.yaml")


@pytest.fixture(autouse=True)
def in_repository(monkeypatch, request):
    """Case files are named from the repository."""
    monkeypatch.chdir(request.config.rootpath)


@pytest.mark.parametrize("name", ["short", "drum"])
def test_every_variant_of_a_case_is_a_case(name, tmp_path):
    file = Path("cases") / name / "case.yaml"
    case = load_case(file)
    variants = bed_variants(case)
    assert "base" in variants and {"seed_1", "stiffness_10"} <= set(variants)
    for one in variants.values():
        found = write_variant(file, on_one_rank(one.variant), tmp_path / one.variant.name)
        assert one.variant.name == "base" or found | {"run": 0} != case | {"run": 0}
        if one.axis == "stiffness and step":
            contact, particles = found["contact"], case["particles"]
            rayleigh = rayleigh_time(
                contact["young_modulus_Pa"], contact["poisson_ratio_1"], particles["density_kg_m3"],
                particles["diameter_m"] / 2,
            )  # fmt: skip
            assert 0.1 < found["time"]["dem_step_s"] / rayleigh <= RAYLEIGH_SHARE_MAX
        if "gas" in one.axis:
            assert is_multiple(found["time"]["frame_interval_s"], found["time"]["gas_step_s"])
    assert ("drag_koch_hill" in variants) == (case["gas"]["model"] == "coupled")


def test_variants_are_named_or_all_or_none():
    case = load_case(SHORT)
    everything = list(bed_variants(case))
    assert wanted_variants(None, case, archived=False) == everything
    assert wanted_variants(None, case, archived=True) == wanted_variants({"dem": "none"}, case, False) == []
    assert wanted_variants({"dem": "all"}, case, archived=True) == everything
    assert set(wanted_variants({"dem": ["base", "friction_0"]}, case, True)) == {"base", "friction_0"}
    assert wanted_variants({"dem": "base"}, case, True) == ["base"]


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ({"dem": ["base", "friktion_0"]}, r"no variant friktion_0; take of .*friction_0"),
        ({"dme": "all"}, "tradeoff has no dme"),
        ({"dem": 3}, "tradeoff.dem 3: take"),
        ("all", "tradeoff=all: take"),
    ],
)
def test_a_wrong_option_is_told_the_right_ones(option, said, capsys):
    with pytest.raises(UserError, match=said):
        wanted_variants(option, load_case(SHORT), archived=False)
    with pytest.raises(SystemExit):
        variants_or_exit(option, load_case(SHORT), False)
    assert "Traceback" not in capsys.readouterr().err
