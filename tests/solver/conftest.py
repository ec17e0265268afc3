# SPDX-License-Identifier: GPL-3.0-or-later
"""The built solver, and beds of a few hundred particles to run it on."""

import pytest
import yaml

from bedchain.dem.parameter_files import write_parameters
from made import ROOT
from made.workflow import built_solver

TINY = {
    "title": "tiny bed for the tests",
    "seed": 10007,
    "bed": {"width_m": 0.02, "height_m": 0.06},
    "particles": {"number": 300},
    "time": {
        "settle_s": 0.15,
        "ramp_s": 0.02,
        "end_s": 0.06,
        "frame_interval_s": 0.004,
        "segment_s": 0.02,
    },
    "learning": {"start_s": 0.02, "end_s": 0.04},
    "comparison": {"start_s": 0.04, "end_s": 0.06},
    "chain": {"lag_s": 0.004},
    "cells": {"columns": 2, "rows": 6},
    "mixing": {"split_z_m": 0.01},
    "figures": {"batch_height_m": 0.01, "moments_s": [0.004, 0.008, 0.012, 0.016]},
}


@pytest.fixture(scope="session")
def solver():
    """Path of bedFoam, built where that is needed."""
    return built_solver()


@pytest.fixture
def make_bed(solver, tmp_path, monkeypatch):
    """Function that writes the parameters of a tiny bed, with changes by section, and returns its folder."""
    monkeypatch.chdir(ROOT)

    def make(name, **changes):
        case = {section: dict(keys) if isinstance(keys, dict) else keys for section, keys in TINY.items()}
        for section, keys in changes.items():
            case.setdefault(section, {}).update(keys)
        file = tmp_path / f"{name}.yaml"
        file.write_text(yaml.safe_dump(case))
        folder = tmp_path / name
        write_parameters(file, folder)
        return folder

    return make
