# SPDX-License-Identifier: GPL-3.0-or-later
"""Random cases, and the way through the stages on made frames that they take."""

import json
import tempfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import yaml
from hypothesis import strategies as st

from assign_cells import Division, assign_cells
from bedchain.case.load import load_case
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.curves import ChainFiles
from bedchain.errors import UserError
from bedchain.measures.batch import Batch
from bedchain.measures.mixing import Splits
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles, trajectory_metadata
from bedchain.trajectory.synthetic import persistent_walk
from build_transitions import build_transitions
from compare_mixing import SolverSeries, Tables, compare_mixing
from discuss_errors import CaseChains, Scanned, discuss_errors
from made.synthetic_bed import write_series
from run_chain import run_chain

WIDTH, HEIGHT, NUMBER, FRAMES = 0.04, 0.08, 60, 40
WALK = persistent_walk(FRAMES, NUMBER, (WIDTH, HEIGHT), 0.05, 0.3, 1)
INTERVALS = st.sampled_from([0.02, 0.025, 0.03, 0.05])
MODELS = ["static", "dynamic", "velocity_class", "jump", "recurrence"]
SPLITS = st.sampled_from([0.001, 0.03, 0.079])
SECONDS = st.sampled_from([0.02, 0.025, 0.03, 0.05, 0.06, 0.075, 0.1, 0.5, 1.0])


def some(values):
    """Lists of one or two different values."""
    return st.lists(values, min_size=1, max_size=2, unique=True)


@st.composite
def case_files(draw):
    """Content of a case file whose windows fit into the walk; its other keys may not go together."""
    interval = draw(INTERVALS)
    lag, start = draw(st.integers(1, 3)), draw(st.integers(0, 4))
    learned, gap, compared = (
        draw(st.integers(2 * lag, 16)),
        draw(st.integers(0, 3)),
        lag * draw(st.integers(2, 4)),
    )
    steps = np.cumsum([start, learned, gap, compared])
    times = [round(float(step) * interval, 6) for step in steps]
    moments = sorted(draw(some(st.integers(1, compared // lag))))
    return {
        "title": "random", "seed": 10007,
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"number": NUMBER},
        "run": {"ranks": 1},
        "time": {"end_s": times[3], "ramp_s": 0.01, "frame_interval_s": interval, "segment_s": interval},
        "gas": {"cell_size_m": 0.002},
        "learning": {"start_s": times[0], "end_s": times[1]},
        "comparison": {"start_s": times[2], "end_s": times[3]},
        "cells": {"columns": draw(st.integers(1, 8)), "rows": draw(st.integers(1, 8))},
        "chain": {
            "lag_s": round(lag * interval, 6),
            "estimator": draw(st.sampled_from(["literal", "per_step", "pooled"])),
            "models": draw(some(st.sampled_from(MODELS))),
            "velocity_class": {"earlier_s": draw(st.sampled_from([0, interval, 0.05]))},
            "recurrence": {
                "segment_s": draw(SECONDS), "separation_s": draw(st.sampled_from([0, 0.05, 0.1])),
                "neighbours": draw(st.integers(1, 30)),
            },
        },
        "mixing": {"split_x_m": draw(st.sampled_from([0.001, 0.02, 0.039])), "split_z_m": draw(SPLITS)},
        "discussion": {
            "cell_sizes_m": draw(some(st.sampled_from([0.001, 0.01, 0.5]))),
            "lags_s": draw(some(st.just(interval) | SECONDS)),
        },
        "figures": {
            "moments_s": [round(moment * lag * interval, 6) for moment in moments],
            "batch_height_m": draw(st.sampled_from([0.001, 0.02, 0.079])),
        },
    }  # fmt: skip


def through_all_stages(folder, case):
    """Take the walk through the stages of a case, as their rules do."""
    interval = case["time"]["frame_interval_s"]
    times = [round(frame * interval, 6) for frame in range(FRAMES)]
    entries = [{"step": frame, "time_s": time} for frame, time in enumerate(times)]
    about = trajectory_metadata(
        {"frames": entries, "frame_interval_s": interval}, np.arange(1, NUMBER + 1), WIDTH, HEIGHT
    )
    bed = BedFiles(folder / "trajectory.npy", folder / "trajectory.json", folder / "cells.npz")
    np.save(
        bed.trajectory, np.stack([WALK.x_m, WALK.z_m, WALK.vx_m_s, WALK.vz_m_s], axis=1).astype(np.float32)
    )
    bed.metadata.write_text(json.dumps(about))
    chain, names = case["chain"], case["chain"]["models"]
    learning, comparison = Window(**case["learning"]), Window(case["comparison"]["start_s"], times[-1])
    comparison = comparison._replace(end_s=case["comparison"]["end_s"])
    splits = Splits(**case["mixing"])
    batch = Batch(case["figures"]["batch_height_m"], case["figures"]["moments_s"])
    assign_cells(bed, bed.cells, Division(**case["cells"]), diameter_m=case["particles"]["diameter_m"])
    for name in names:
        options = chain.get(name, {})
        transitions = folder / f"transitions_{name}.npz"
        build_transitions(bed, transitions, name, chain["estimator"], chain["lag_s"], learning, options)
        run_chain(
            bed, transitions, folder / f"{name}.npz", learning, comparison, splits, batch,
            ModelSettings(chain["estimator"], chain["seed"], options),
        )  # fmt: skip
    series = write_series(folder, np.array(times), 800.0, 0.04, NUMBER)
    mixing = folder / "mixing.csv"
    compare_mixing(
        bed, ChainFiles(names, [folder / f"{name}.npz" for name in names]),
        SolverSeries(series, Window(learning.start_s, comparison.end_s), 800.0), [],
        Tables(mixing, folder / "metrics.csv"), comparison, splits, batch.batch_height_m,
    )  # fmt: skip
    own = CaseChains(**case["cells"], lag_s=chain["lag_s"], estimator=chain["estimator"])
    figured = [name for name in names if name in ("static", "dynamic")]
    discuss_errors(
        bed, mixing, folder / "discussion.csv", learning, comparison, splits, own,
        Scanned(figured, **case["discussion"]),
    )  # fmt: skip


def try_out(content):
    """Load a case and take the walk through its stages; a sentence for the user is an end, too."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "case.yaml"
        file.write_text(yaml.safe_dump(content), encoding="utf-8")
        with suppress(UserError):  # anything else fails
            through_all_stages(Path(folder), load_case(file))
