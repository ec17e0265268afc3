# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that no machine can hold (issue 18, kind 5): each ends in one clear sentence."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema, schema_keys
from bedchain.errors import CaseError
from bedchain.studies.stability.bed_settings import bed_settings
from made.case_text import CASE, END, assert_refused, changed_case

MISTAKES = [
    # replaced, by, key named, in the message
    ("width_m: 0.09", "width_m: 30", "bed.width_m", "30 m wide: were millimetres meant?; 30 mm are 0.03"),
    ("height_m: 0.45", "height_m: 450", "bed.height_m", "450 m high: were millimetres meant?"),
    ("width_m: 0.09", "width_m: 0.09\n  thickness_m: 11", "bed.thickness_m", "11 m thick: were millimetres"),
    ("number: 7200", "number: 7200\n  diameter_m: 1.0", "particles.diameter_m", "1 mm are 0.001 here"),
    ("width_m: 0.09", "width_m: 1e308", "bed.width_m", "at most 10000"),
    ("number: 7200", "number: 1000000000", "particles.number", "at most 100000000"),
    (END, "  end_s: 1e5", "time.end_s", "take at most 2.5e+03 s"),
    (END, "  segment_s: 0.025\n  end_s: 500", "time.end_s", "(time.segment_s) of 0.025 s, more than 9999"),
    (END, "  dem_step_s: 1e-9\n" + END, "time.end_s", "more than 2147483647"),
    ("columns: 10", "columns: 10000", "cells.columns", "at most 90"),
    ("rows: 50", "rows: 10001", "cells.rows", "at most 10000"),
    ("comparison:", "comparison:\n  repeats: 20000", "comparison.repeats", "at most 100"),
    ("split_z_m: 0.081", "split_z_m: 0.081\nchain: {models: [recurrence], recurrence: {coarse_m: 1e-5}}",
     "chain.recurrence.coarse_m", "take at least 0.001"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_and_remedy(tmp_path, old, new, key, message):
    with pytest.raises(CaseError) as caught:
        load_case(changed_case(tmp_path, (old, new)))
    words = [f"{item.wrong}; {item.remedy}" for item in caught.value.problems if item.key == key]
    assert any(message in text for text in words), caught.value


def test_many_cells_are_refused(tmp_path):
    case = CASE.replace("columns: 10", "columns: 5000").replace("rows: 50", "rows: 5000")
    (tmp_path / "case.yaml").write_text(case, encoding="utf-8")
    assert_refused(tmp_path / "case.yaml", "cells.rows", "")
    with pytest.raises(CaseError, match="25000000, more than 4000000; take at most 800 rows"):
        load_case(tmp_path / "case.yaml")


def numeric(part):
    return part.get("type") in ("number", "integer") and "enum" not in part


def test_every_number_of_the_schema_has_a_least_and_a_largest_value():
    parts = {key: part.get("items", part) for key, part in schema_keys(load_schema()).items()}
    numbers = {key: part for key, part in parts.items() if numeric(part)}
    assert len(numbers) > 40
    for key, part in numbers.items():
        assert {"minimum", "exclusiveMinimum"} & set(part), key
        assert {"maximum", "exclusiveMaximum"} & set(part), key
    lists = [key for key, part in schema_keys(load_schema()).items() if numeric(part.get("items", {}))]
    assert all("maxItems" in schema_keys(load_schema())[key] for key in lists)


@pytest.mark.parametrize(
    "value", ["9" * 400, "-" + "9" * 400, "1e308", "-1e308", "1e-308", "5e-324", "0", "-1"]
)
def test_extremes_of_every_number_end_in_a_short_sentence_or_are_taken(tmp_path, value):
    schema = load_schema()["properties"]
    for name in (
        "seed",
        "particles",
        "bed",
        "contact",
        "gas",
        "time",
        "comparison",
        "cells",
        "mixing",
        "figures",
    ):
        keys = schema_keys(schema[name]) if "properties" in schema[name] else {"": schema[name]}
        for key, part in keys.items():
            if numeric(part):
                text = f"{name}: {{{key}: {value}}}\n" if key else f"{name}: {value}\n"
                refused(tmp_path, text)


def refused(folder, text):
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert max(map(len, str(caught.value).splitlines())) < 1000


def test_the_extremes_of_the_stability_study_are_within_the_limits_of_the_schema():
    limits = schema_keys(load_schema())
    columns = {
        "diameter_m": "particles.diameter_m", "density_kg_m3": "particles.density_kg_m3",
        "young_Pa": "contact.young_modulus_Pa", "dem_step_s": "time.dem_step_s",
        "gas_step_s": "time.gas_step_s", "velocity_m_s": "gas.superficial_velocity_m_s",
        "gas_cell_m": "gas.cell_size_m",
    }  # fmt: skip
    for setting in bed_settings():
        for column in columns.keys() & setting.values.keys():
            part = limits[columns[column]]
            assert part["minimum"] <= setting.values[column] <= part["maximum"], (setting.name, column)
