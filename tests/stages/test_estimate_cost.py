# SPDX-License-Identifier: GPL-3.0-or-later
"""The stage that estimates: a table and a text before anything is there, and the ratio after a run."""

import json

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.studies.cost.machine_speed import SOLVERS, bed_of, solver_seconds
from bedchain.trajectory.store import STORED, trajectory_metadata
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
    assert "on more ranks" in text and "particles spread evenly" in text


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
    assert table.index[0] == "assign_cells" and "reference=simulate" in text and "more ranks" not in text


def test_more_ranks_wait_for_the_fullest_slab_of_the_bed_that_is_there(case, estimate, tmp_path):
    _, even = estimate()
    bed, number, times = tmp_path / "results" / "short", case["particles"]["number"], [0.0, 2.0, 2.5]
    np.save(bed / "trajectory.npy", np.full((len(times), len(STORED), number), 0.01, np.float32))
    manifest = {"frames": [{"time_s": time, "step": int(1e4 * time)} for time in times]}
    described = trajectory_metadata(manifest | {"frame_interval_s": 0.5}, np.arange(number), 0.1, 0.4)
    (bed / "trajectory.json").write_text(json.dumps(described))
    _, crowded = estimate()
    assert "as they are from the learning window on" in crowded
    two, full = (
        next(line.split() for line in text.splitlines() if line.startswith("2 ")) for text in (even, crowded)
    )
    assert float(two[1]) == 1 and float(full[1]) == 2
    assert float(two[4]) > 1.8 and float(full[4]) < 1.2
