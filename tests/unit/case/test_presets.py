# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the chains: read, refused, and brought onto beds whose cells and windows do not fit them."""

import copy

import pytest
import yaml

from bedchain.case.chosen import is_auto
from bedchain.case.load import give_hint, load_case
from bedchain.case.presets import (
    Preset,
    preset_named,
    read_presets,
    simulated_case,
    with_preset,
    with_preset_bed,
)
from bedchain.dem.parameter_files import write_parameters
from bedchain.dem.segments import read_parameters
from bedchain.errors import CaseError, UserError
from bedchain.workflow import case_or_exit, preset_name
from made import ROOT

FAST = {"cell_m": 0.02, "lag_s": 0.2, "model": "static", "cost_s": 0.01, "error_floors": 2.5}
FINE = {"cell_m": 0.01, "lag_s": 0.025, "model": "dynamic", "measured_on": "a bed of this test"}


@pytest.fixture
def presets(tmp_path):
    file = tmp_path / "presets.yaml"
    file.write_text(yaml.safe_dump({"fast": FAST, "accurate": FINE}, sort_keys=False))
    return file


@pytest.fixture(scope="module")
def short():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


@pytest.fixture(scope="module")
def paper():
    return load_case(ROOT / "cases" / "paper" / "case.yaml")


def preset(cell_m=0.02, lag_s=0.2, model="static"):
    return Preset("tried", cell_m, lag_s, model)


def test_presets_are_read_with_what_was_measured(presets):
    fast, accurate = read_presets(presets).values()
    assert fast == Preset("fast", 0.02, 0.2, "static", 0.01, 2.5)
    assert accurate.error_floors != accurate.error_floors and accurate.measured_on == "a bed of this test"


def test_an_unknown_preset_is_told_the_known_ones(presets):
    with pytest.raises(UserError, match="no preset 'fats' in .*: take one of fast, accurate"):
        preset_named("fats", presets)


def test_without_presets_the_study_that_makes_them_is_named(tmp_path):
    assert read_presets(tmp_path / "none.yaml") == {}
    with pytest.raises(UserError, match=r"none\.yaml holds no presets; snakemake tradeoff"):
        preset_named("fast", tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("cell_m", None, "cell_m is None, not a number above 0"),
        ("cell_m", "1 cm", "cell_m is '1 cm', not a number above 0"),
        ("lag_s", -0.2, "lag_s is -0.2, not a number above 0"),
        ("lag_s", True, "lag_s is True, not a number above 0"),
        ("model", "statics", "model is 'statics', not one of static, dynamic"),
        ("cost_s", "10 ms", "cost_s is '10 ms', not a number above 0"),
        ("lagg_s", 0.2, "lagg_s is an unknown key; did you mean lag_s"),
    ],
)
def test_a_setting_that_cannot_be_is_named(tmp_path, key, value, said):
    file = tmp_path / "presets.yaml"
    file.write_text(yaml.safe_dump({"fast": FAST | {key: value}}))
    with pytest.raises(UserError, match=said):
        read_presets(file)


def test_what_is_no_table_of_presets_is_refused(tmp_path):
    file = tmp_path / "presets.yaml"
    for text, said in (("- fast", "holds no presets"), ("fast: 3", "fast: 3 is no preset")):
        file.write_text(text)
        with pytest.raises(UserError, match=said):
            read_presets(file)


def test_a_preset_changes_cells_lag_and_model_only(short):
    before = copy.deepcopy(short)
    changed = with_preset(short, preset())
    assert short == before
    # 5 columns would have the middle line within a cell, where the case has it on a border
    assert changed["cells"] == {"columns": 4, "rows": 20}
    assert changed["chain"]["lag_s"] == 0.2 and changed["chain"]["models"] == ["static"]
    for section in set(short) - {"cells", "chain"}:
        assert changed[section] == short[section]


def test_cells_divide_the_levels_of_an_archive_and_keep_lines_on_borders(paper):
    # levels of 0.5 mm; 0.25 m is a border of the case's rows, 0.135 m of none of its columns
    assert with_preset(paper, preset(0.01))["cells"] == {"columns": 27, "rows": 105}
    assert with_preset(paper, preset(0.02))["cells"] == {"columns": 15, "rows": 42}
    assert with_preset(paper, preset(0.0025))["cells"] == {"columns": 108, "rows": 420}
    assert with_preset(paper, preset(0.05))["cells"] == {"columns": 5, "rows": 21}


def test_the_lag_is_the_nearest_multiple_of_the_frame_interval(paper, short):
    assert with_preset(paper, preset(lag_s=0.33))["chain"]["lag_s"] == 0.325
    assert with_preset(short, preset(lag_s=0.31))["chain"]["lag_s"] == pytest.approx(0.3)
    assert with_preset(short, preset(lag_s=1e-3))["chain"]["lag_s"] == 0.025


def test_a_preset_too_coarse_for_the_windows_is_refused_by_name(short):
    with pytest.raises(CaseError, match="tried on short bed.*\n.*chain.lag_s"):
        with_preset(short, preset(lag_s=2.0))


@pytest.mark.parametrize(("key", "hints"), [("preset", []), ("fidelity", ["fidelity is now called preset"])])
def test_a_case_selects_by_one_key_and_the_command_line_goes_first(
    presets, tmp_path, monkeypatch, caplog, key, hints
):
    (tmp_path / "cases" / "own").mkdir(parents=True)
    text = (ROOT / "cases" / "short" / "case.yaml").read_text()
    (tmp_path / "cases" / "own" / "case.yaml").write_text(f"{text}\n{key}: fast\n")
    presets.rename(tmp_path / "cases" / "presets.yaml")
    monkeypatch.chdir(tmp_path)
    give_hint.cache_clear()
    case = case_or_exit("own")
    assert case["chain"]["models"] == ["static"] and case["preset"] == "fast" and "fidelity" not in case
    assert case_or_exit("own", "accurate")["chain"]["models"] == ["dynamic"]
    assert caplog.messages == [f"hint: cases/own/case.yaml: {hint}" for hint in hints]
    with pytest.raises(SystemExit):
        case_or_exit("own", "best")


def test_the_command_line_takes_the_old_word_with_one_hint(caplog):
    give_hint.cache_clear()
    assert [preset_name({"preset": "fast"}), preset_name({"case": "short"})] == ["fast", None]
    assert [preset_name({"fidelity": "fast"}), preset_name({"fidelity": "fast"})] == ["fast", "fast"]
    assert caplog.messages == ["hint: --config: fidelity is now called preset"]


def test_the_old_key_beside_the_new_one_is_refused(tmp_path):
    file = tmp_path / "case.yaml"
    text = (ROOT / "cases" / "short" / "case.yaml").read_text()
    file.write_text(f"{text}\npreset: fast\nfidelity: accurate\n")
    with pytest.raises(CaseError, match="fidelity: is an unknown key"):
        load_case(file)


def test_a_preset_may_leave_cells_and_lag_to_the_rule(short, tmp_path):
    file = tmp_path / "presets.yaml"
    file.write_text("own: {cell_m: auto, lag_s: auto, model: dynamic}\n")
    changed = with_preset(short, read_presets(file)["own"])
    assert is_auto(changed) and changed["chain"]["models"] == ["dynamic"]
    assert changed["cells"] == {"columns": "auto", "rows": "auto"} and changed["chain"]["lag_s"] == "auto"


def test_a_preset_changes_the_bed_as_far_as_the_case_allows(short, caplog):
    bed = {"young_modulus_times": 0.1, "parcel_diameters": 2.0}
    stiff = copy.deepcopy(short)
    stiff["contact"]["young_modulus_Pa"] *= 100
    stiff["time"]["dem_step_s"] /= 10
    fast = with_preset_bed(stiff, Preset("fast", 0.02, 0.2, "static", bed=bed))
    assert fast["contact"]["young_modulus_Pa"] == pytest.approx(stiff["contact"]["young_modulus_Pa"] / 10)
    # with its root, as near as the gas step divides
    assert 2.4 < fast["time"]["dem_step_s"] / stiff["time"]["dem_step_s"] <= 10**0.5
    assert fast["gas"] == short["gas"] and not caplog.records
    assert fast["particles"]["parcel_diameters"] == 2 and short["particles"]["parcel_diameters"] == 1
    # particles that would be too soft, and parcels too wide for the gas cells, are left out by name
    too_far = {"young_modulus_times": 0.1, "dem_step_times": 4.0, "parcel_diameters": 9.0}
    same = with_preset_bed(short, Preset("fast", 0.02, 0.2, "static", bed=too_far))
    assert all(same[section] == short[section] for section in ("contact", "time", "particles"))
    assert [record.args[:2] for record in caplog.records] == [
        ("fast", "young_modulus_times"),
        ("fast", "dem_step_times"),
        ("fast", "parcel_diameters"),
    ]


def test_a_preset_lengthens_the_step_after_it_softened_the_particles(paper):
    preset = Preset("balanced", 0.02, 0.2, "static", bed={"young_modulus_times": 1.0, "dem_step_times": 1.6})
    longer = with_preset_bed(paper, preset)
    assert longer["time"]["dem_step_s"] == pytest.approx(1.6 * paper["time"]["dem_step_s"])
    assert longer["contact"] == paper["contact"]


def test_a_bed_without_gas_takes_only_what_concerns_particles(caplog):
    drum = load_case(ROOT / "cases" / "drum" / "case.yaml")
    bed = {"young_modulus_times": 0.1, "parcel_diameters": 2.0}
    softer = with_preset_bed(drum, Preset("fast", 0.02, 0.2, "static", bed=bed))
    assert softer["particles"] == drum["particles"] and not caplog.records
    assert softer["contact"]["young_modulus_Pa"] == pytest.approx(drum["contact"]["young_modulus_Pa"] / 10)


def test_only_a_simulated_bed_is_that_of_the_preset(short, paper):
    assert simulated_case(short, "fast", None)["particles"]["parcel_diameters"] == 2
    assert simulated_case(short | {"preset": "fast"}, None, None)["particles"]["parcel_diameters"] == 2
    assert simulated_case(paper, "fast", ROOT / "cases" / "paper" / "reference") is paper
    assert simulated_case(short, None, None) is short
    frames = short | {"frames": {"files": "*.dump"}}
    assert simulated_case(frames, "fast", None) is frames


def test_the_solvers_get_the_bed_of_the_preset(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    case = ROOT / "cases" / "short" / "case.yaml"
    for preset, folder in ((None, "own"), ("fast", "fast")):
        write_parameters(case, tmp_path / folder, preset)
    own, fast = (read_parameters(tmp_path / name / "parameters.lig") for name in ("own", "fast"))
    assert own["number"] == 4 * fast["number"] and fast["particles_per_parcel"] == 4
