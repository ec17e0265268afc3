# SPDX-License-Identifier: GPL-3.0-or-later
"""Each input of each stage damaged (issue 18, kind 8): one sentence that names the file, and no traceback.

The files have no notes of their makers, as those of an earlier version; notes are in unit/test_marks.py.
A folder in place of a file stands for a permission that is denied, which root is not denied.
"""

import shutil
from pathlib import Path

import pytest

from assign_cells import assign_cells
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.curves import ChainFiles
from bedchain.errors import report_user_errors
from bedchain.figures.style import FigureFiles
from bedchain.measures.batch import Batch
from bedchain.stage import known_files
from bedchain.trajectory.store import BedFiles
from build_transitions import build_transitions
from compare_mixing import SolverSeries, Tables, compare_mixing
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    HEIGHT,
    LEARN,
    MODELS,
    MOMENTS,
    ROWS,
    SPLITS,
    WEIGHT_PA,
    WIDTH,
)
from parse_dumps import parse_dumps
from plot_cells import plot_cells
from plot_difference import plot_difference
from plot_distribution import plot_distribution
from run_chain import run_chain

BED = ("trajectory.npy", "trajectory.json")
CHAINS = tuple(f"chain_{model}.npz" for model in MODELS)


def files_of(at):
    return BedFiles(*(at / name for name in BED), at / "cells.npz")


def figure(at):
    return FigureFiles(at / "out.png", at / "out.pdf", at / "out.csv")


def compare(at):
    compare_mixing(
        files_of(at), ChainFiles(list(MODELS), [at / name for name in CHAINS]),
        SolverSeries(at / "bed_series.csv", LEARN, WEIGHT_PA), [], Tables(at / "out.csv", at / "out_2.csv"),
        COMPARE, SPLITS, BATCH,
    )  # fmt: skip


# a stage on the files of a folder, and the inputs that it reads
STAGES = {
    "parse_dumps": (
        lambda at: parse_dumps(at / "dem.json", at / "out.npy", at / "out.json", WIDTH, HEIGHT, False),
        ("dem.json",),
    ),
    "assign_cells": (
        lambda at: assign_cells(files_of(at), at / "out.npz", COLUMNS, ROWS, DIAMETER),
        BED,
    ),
    "build_transitions": (
        lambda at: build_transitions(files_of(at), at / "out.npz", "static", "pooled", 0.025, LEARN),
        (*BED, "cells.npz"),
    ),
    "run_chain": (
        lambda at: run_chain(
            files_of(at), at / "transitions_static.npz", at / "out.npz", LEARN, COMPARE, SPLITS,
            Batch(BATCH, MOMENTS), ModelSettings("pooled", 3),
        ),
        (*BED, "cells.npz", "transitions_static.npz"),
    ),
    "compare_mixing": (compare, (*BED, "cells.npz", *CHAINS, "bed_series.csv")),
    "plot_cells": (
        lambda at: plot_cells(files_of(at), figure(at), COMPARE.start_s, DIAMETER, "black"),
        (*BED, "cells.npz"),
    ),
    "plot_distribution": (
        lambda at: plot_distribution(
            at / "cells.npz", at / "chain_static.npz", figure(at), "static", COMPARE.start_s, BATCH, "viridis"
        ),
        ("cells.npz", "chain_static.npz"),
    ),
    "plot_difference": (
        lambda at: plot_difference(at / "cells.npz", *(at / name for name in CHAINS), figure(at)),
        ("cells.npz", *CHAINS),
    ),
}  # fmt: skip
DAMAGES = {
    "cut": lambda file, content: file.write_bytes(content[: len(content) // 2]),
    "zeros": lambda file, content: file.write_bytes(bytes(len(content))),
    "empty": lambda file, content: file.write_bytes(b""),
    "missing": lambda file, content: None,
    "a folder": lambda file, content: file.mkdir(),
}


@pytest.fixture(scope="module")
def copy(bed, tmp_path_factory):
    """A copy of the small bed's artefacts, to be damaged."""
    folder = tmp_path_factory.mktemp("copy")
    return Path(shutil.copytree(bed.folder, folder, dirs_exist_ok=True))


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize(("stage", "name"), [(stage, name) for stage in STAGES for name in STAGES[stage][1]])
def test_a_damaged_input_is_named(copy, capsys, stage, name, damage):
    run, inputs = STAGES[stage]
    file = copy / name
    content = file.read_bytes()
    file.unlink()
    try:
        DAMAGES[damage](file, content)
        with (
            pytest.raises(SystemExit) as ended,
            report_user_errors(),
            known_files([copy / part for part in inputs], []),
        ):
            run(copy)
        assert ended.value.code == 1
        assert name in capsys.readouterr().err
        assert not list(copy.glob("out*"))
    finally:
        shutil.rmtree(file) if file.is_dir() else file.unlink(missing_ok=True)
        for made in copy.glob("out*"):
            made.unlink()
        file.write_bytes(content)
