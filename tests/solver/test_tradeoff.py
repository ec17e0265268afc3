# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a tiny bed by the real solvers: one that runs, one that they stop, and what is kept."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.case.variants import Variant
from bedchain.dem.run import repeat_dem, run_dem
from bedchain.measures.mixing import Splits
from bedchain.studies.tradeoff.bed_variants import BedVariant, bed_variants
from bedchain.studies.tradeoff.simulated_beds import PEAK_FILE, measure_all, simulate_bed
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from measure_mixing import measure_mixing
from parse_dumps import parse_dumps
from study_tradeoff import opened

# a run of a few hundred particles: its solvers' peak is that of their libraries
LEAST_MB, MOST_MB = 5.0, 500.0


@pytest.fixture
def bed(make_bed):
    """Case file and folder of a tiny bed with one repeat, as far as the study needs them."""
    folder = make_bed("tiny", comparison={"repeats": 1}, time={"frame_interval_s": 0.002})
    file = folder.with_suffix(".yaml")
    case = load_case(file)
    time, compared, lines = case["time"], case["comparison"], case["mixing"]
    run_dem(folder, time["end_s"], time["segment_s"], 1)
    repeat_dem(folder, compared["start_s"], time["end_s"], time["segment_s"], 1, 1)
    for path in (folder, folder / "repeats" / "1"):
        files = path / "trajectory.npy", path / "trajectory.json"
        parse_dumps(
            path / "dem.json", *files, case["bed"]["width_m"], case["bed"]["height_m"], progress=False
        )
    measure_mixing(
        BedFiles(*files), path / "mixing.csv", "dem_1", Window(compared["start_s"], compared["end_s"]),
        Splits(**lines),
    )  # fmt: skip
    return file, folder


def test_variants_run_fail_and_are_not_run_again(bed, tmp_path):
    file, folder = bed
    case = load_case(file)
    bench, _ = opened(case, folder)
    wanted = [
        bed_variants(case)["friction_0.3"],
        BedVariant("contact", Variant("overlap", {"contact.largest_overlap_1": 1e-6})),
    ]
    tradeoff = tmp_path / "tradeoff"
    for bed_variant in wanted:
        simulate_bed(file, bed_variant, tradeoff / bed_variant.variant.name)
    good, stopped = measure_all(wanted, tradeoff, bench.reference)
    assert good["problem"] == "" and good["cost_s"] > 0 and LEAST_MB < good["memory_mb"] < MOST_MB
    for name in ("mixing", "density", "bed_height", "pressure_drop", "granular_temperature"):
        assert np.isfinite(good[f"{name}_floors_1"])
    assert abs(good["bed_height_error_m"]) < 0.1 * bench.reference.scalars["bed_height"][0]
    assert "overlap" in stopped["problem"] and "cost_s" not in stopped
    state = tradeoff / "friction_0.3"
    before = {path: path.stat().st_mtime_ns for path in (state / "dem").rglob("*/*") if path.is_file()}
    simulate_bed(file, wanted[0], state)
    (again,) = measure_all(wanted[:1], tradeoff, bench.reference)
    assert {path: path.stat().st_mtime_ns for path in before} == before
    # its memory, too, which a finished run no longer shows
    assert (state / PEAK_FILE).exists()
    pd.testing.assert_series_equal(pd.Series(again), pd.Series(good))
