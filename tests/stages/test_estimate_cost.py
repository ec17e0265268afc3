# SPDX-License-Identifier: GPL-3.0-or-later
"""The stage that estimates: a table and a text before anything is there, and the ratio after a run."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.studies.cost.machine_speed import SOLVERS, bed_of, solver_seconds
from estimate_cost import estimate_cost
from made import ROOT


@pytest.fixture(scope="module")
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


@pytest.fixture
def estimate(case, tmp_path):
    """Runs the stage; gives its table and its text."""
    bed = tmp_path / "results" / "short"
    targets = bed / "estimate.csv", bed / "estimate.txt"

    def run(archived=False):
        records = {str(file): 0 for file in sorted((tmp_path / "results").glob("*/dem.json"))}
        benchmarks = dict.fromkeys(("bed", "made"), str(tmp_path / "benchmarks"))
        estimate_cost(case, str(bed), benchmarks, records, archived, tmp_path / "presets.yaml", *targets)
        return pd.read_csv(targets[0]).set_index("stage"), targets[1].read_text()

    return run


def test_before_a_run_everything_is_estimated_by_a_probe(case, estimate, tmp_path):
    preset = "own: {cell_m: 0.01, lag_s: 0.025, model: static, error_floors: 2.5}\n"
    (tmp_path / "presets.yaml").write_text(preset)
    table, text = estimate()
    assert list(table.columns) == [
        *("wall_s", "memory_mb", "disk_mb", "error_floors"),
        *("happened_wall_s", "happened_memory_mb", "happened_disk_mb", "happened_error_floors"),
        *("done_1", "ratio_1"),
    ]
    assert table["wall_s"].gt(0).all() and table["happened_wall_s"].isna().all()
    assert table.loc["run_chain_static", "error_floors"] == 2.5
    assert case["title"] in text and "probe" in text and "total" in text and "nan" not in text.lower()


def test_after_a_run_a_stage_far_from_its_estimate_is_named(case, estimate, tmp_path, caplog):
    before, _ = estimate()
    bed = tmp_path / "results" / "short"
    (bed / "dem/stamp/segment_0001").mkdir(parents=True)
    spent = solver_seconds(bed_of(case), 2.5)
    spent["gas"] *= 10
    segment = {"start_s": 0, "end_s": 2.5, "folder": "dem/stamp/segment_0001"}
    segment |= {f"{name}_s": spent[name] for name in SOLVERS}
    (bed / "dem.json").write_text(json.dumps({"number": 9000, "ranks": 2, "segments": [segment]}))
    with caplog.at_level("INFO", "bedchain"):
        after, _ = estimate()
    assert after.loc["gas", "done_1"] == pytest.approx(0.5)
    # the probe of each estimate is another, so both sides are taken from the second
    expected = spent["gas"] / (after.loc["gas", "wall_s"] / 2)
    assert after.loc["gas", "ratio_1"] == pytest.approx(expected, rel=1e-6)
    assert np.isfinite(before.loc["gas", "wall_s"])
    assert any(said.startswith("gas came out") for said in caplog.messages)


def test_of_an_archived_bed_only_the_chains_are_estimated(estimate):
    table, text = estimate(archived=True)
    assert table.index[0] == "assign_cells" and "reference=simulate" in text
