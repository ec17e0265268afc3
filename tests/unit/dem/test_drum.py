# SPDX-License-Identifier: GPL-3.0-or-later
"""A drum's case: what it may hold, the numbers it hands on, and what is made of a series without gas."""

import math
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from bedchain.case.load import load_case
from bedchain.case.parameters import liggghts_text, solver_parameters
from bedchain.case.scene import scene_of
from bedchain.case.scene_checks import drum_sites
from bedchain.case.schema import load_schema
from bedchain.comparison.metrics import bed_metrics
from bedchain.dem.drum import input_files
from bedchain.dem.series import read_series
from bedchain.errors import CaseError, UserError
from bedchain.studies import audit
from bedchain.workflow import table_values
from made import ROOT

DRUM = ROOT / "cases" / "drum" / "case.yaml"


@pytest.fixture
def changed(tmp_path):
    """Function that writes the drum's case with changes by section, None for a section to leave out."""

    def change(**changes):
        case = yaml.safe_load(DRUM.read_text(encoding="utf-8"))
        for section, keys in changes.items():
            if keys is None:
                del case[section]
            else:
                case.setdefault(section, {}).update(keys)
        file = tmp_path / "case.yaml"
        file.write_text(yaml.safe_dump(case), encoding="utf-8")
        return file

    return change


MISTAKES = [
    ({"drum": None}, "gas.model", "add drum: {revolution_s: ...}"),
    ({"gas": {"model": "coupled"}}, "gas.model", "does not go with a drum"),
    ({"gas": {"model": "nothing"}}, "gas.model", "coupled, none"),
    ({"bed": {"height_m": 0.25}}, "bed.height_m", "take bed.width_m (0.24 m)"),
    ({"bed": {"layers": "many", "thickness_m": 0.03}}, "bed.layers", "take one"),
    ({"drum": {"revolution_s": 5.25}}, "drum.revolution_s", "multiple of time.frame_interval_s"),
    ({"drum": {"revolution_s": -5.2}}, "drum.revolution_s", "above 0"),
    ({"drum": {"revolution": 5.2}}, "drum.revolution", "did you mean revolution_s?"),
    ({"particles": {"number": 3800}}, "particles.number", "sites in a drum"),
    ({"run": {"dump_format": "text"}}, "run.dump_format", "take binary"),
    ({"comparison": {"repeats": 2, "start_s": 20.8, "end_s": 36.4}}, "comparison.repeats", "take 0"),
    ({"time": {"frame_interval_s": 0.1001}}, "time.frame_interval_s", "multiple of time.dem_step_s"),
]


@pytest.mark.parametrize(("changes", "key", "said"), MISTAKES)
def test_a_drum_that_cannot_be_is_refused_with_key_and_remedy(changed, changes, key, said):
    with pytest.raises(CaseError) as caught:
        load_case(changed(**changes))
    found = [f"{problem.wrong}; {problem.remedy}" for problem in caught.value.problems if problem.key == key]
    assert found and said in found[0], caught.value


def test_keys_of_the_gas_and_its_steps_are_not_asked_of_a_drum(changed):
    free = changed(gas={"cell_size_m": 0.007}, time={"gas_step_s": 3.3e-4, "ramp_s": 99.0})
    assert load_case(free)["gas"]["cell_size_m"] == 0.007


def test_as_many_fit_as_the_lattice_has_sites(changed):
    spacing, radius, reach = 1.15 * 3e-3, 0.12, 0.12 - 1.5e-3
    sites = 0
    for column in range(100):
        for row in range(100):
            x, z = (column + 0.5) * spacing - radius, (row + 0.5) * spacing - radius
            sites += math.sqrt(x * x + z * z) <= reach
    assert drum_sites(0.24, 3e-3) == sites
    load_case(changed(particles={"number": sites}))
    with pytest.raises(CaseError, match=f"take at most {sites}"):
        load_case(changed(particles={"number": sites + 1}))


def test_the_drum_s_speed_reaches_the_decks_and_a_bed_in_a_box_has_none():
    speeds = {}
    for name in ("drum", "short"):
        case = load_case(ROOT / "cases" / name / "case.yaml")
        values = {item.name: item.value for item in solver_parameters(case, load_schema())}
        speeds[name] = values.get("drum_speed")
    assert speeds == {"drum": pytest.approx(2 * math.pi / 5.2, rel=1e-15), "short": None}


def test_the_drum_s_decks_get_every_number_that_they_ask_for():
    case = load_case(DRUM)
    given = set(re.findall(r"^variable (\w+) ", liggghts_text(solver_parameters(case, load_schema())), re.M))
    decks = input_files(Path("results/drum"), ROOT / "liggghts_inputs")[1:]
    text = "\n".join(deck.read_text(encoding="utf-8") for deck in decks)
    own = set(re.findall(r"^variable\s+(\w+)\s+(?:index|equal|atom)", text, re.M))
    assert set(re.findall(r"\$\{(\w+)\}", text)) <= given | own


def test_the_drum_needs_no_gas_and_table_1_shows_none_of_its_numerics():
    case = load_case(DRUM)
    rows = audit.audit(scene_of(case)).set_index("physics")
    assert rows.loc["gas flow", "decision"] == "drop" and rows.loc["gas flow", "built"] == "no"
    assert rows.loc["gas flow", "value"] < 0.05
    kept = set(rows.index[rows["decision"] == "keep"])
    assert "collisions" in kept and "particles act on the gas" not in kept
    # one layer stands for a slice of a long drum: real end walls would carry part of it
    assert set(rows.index[rows["agrees"] == "no"]) == {"friction in front and behind"}
    shown = table_values(case)
    assert shown["gas.model"] == "none" and shown["drum.revolution_s"] == 5.2
    unused = {"gas.cell_size_m", "gas.drag_law", "time.gas_step_s", "contact.largest_overlap_1"}
    assert not unused & set(shown) and unused <= set(table_values(load_case(ROOT / "cases/short/case.yaml")))


def test_dust_in_a_drum_needs_the_gas_and_the_audit_says_that_it_is_not_there():
    case = load_case(DRUM)
    case["particles"]["diameter_m"] = 1e-4
    case["bed"]["thickness_m"] = 1e-4
    rows = audit.audit(scene_of(case)).set_index("physics")
    assert list(rows.loc["gas flow", ["decision", "built", "agrees"]]) == ["keep", "no", "no"]


def drum_series(tmp_path, **columns):
    given = {"time_s": np.arange(40) * 0.1, "mean_height_m": np.full(40, 0.05)} | columns
    pd.DataFrame(given).to_csv(tmp_path / "bed_series.csv", index=False)
    return tmp_path / "bed_series.csv"


def test_a_series_without_gas_gives_height_and_inclination(tmp_path):
    file = drum_series(tmp_path, surface_angle_rad=np.full(40, 0.4))
    found = {row["quantity"]: row["value"] for row in bed_metrics(read_series(file), 800.0, 1.0, 3.0)}
    assert found == {"particle_height_mean": pytest.approx(0.05), "surface_angle_mean": pytest.approx(0.4)}


def test_a_series_with_neither_gas_nor_inclination_is_refused(tmp_path):
    with pytest.raises(UserError, match="has no column pressure_drop_Pa"):
        read_series(drum_series(tmp_path))
