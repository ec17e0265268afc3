# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and pictures of README files on a made-up project."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from bedchain.errors import UserError
from write_readme import PICTURE_WIDTH, write_readme

MARKED = "<!-- table: cases/paper/tables/costs.csv -->\n<!-- end -->\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with one README and the timing of one case."""
    results = tmp_path / "results/paper"
    (results / "figures").mkdir(parents=True)
    (tmp_path / "cases/paper").mkdir(parents=True)
    (tmp_path / "cases/paper/README.md").write_text(MARKED)
    record = {"machine": {"processor": "EPYC", "cores": 2}, "git": {"commit": "0" * 40, "dirty": False}}
    (results / "provenance.json").write_text(json.dumps(record))
    stages = ["dem", *(f"static_{name}" for name in ("count", "matrix", "exact", "monte_carlo"))]
    pd.DataFrame({"stage": stages, "wall_s": [60, 0.1, 0.1, 0.1, 0.1]}).to_csv(
        results / "timing.csv", index=False
    )
    noise = np.random.default_rng(1).integers(0, 255, (600, 2 * PICTURE_WIDTH, 3), np.uint8)
    Image.fromarray(noise).save(results / "figures/snapshot.png")
    return tmp_path


def test_results_become_a_csv_file_and_that_a_table(project: Path) -> None:
    write_readme("paper", None, project)
    table = pd.read_csv(project / "cases/paper/tables/costs.csv", dtype=str)
    assert set(table["commit"]) == {"0" * 12}
    text = (project / "cases/paper/README.md").read_text()
    assert "| DEM and gas, comparison window | 60 s |" in text
    assert "<sub>EPYC, 2 cores, commit 000000000000</sub>" in text


def test_a_csv_file_that_no_text_shows_is_not_made(project: Path) -> None:
    (project / "cases/paper/README.md").write_text(MARKED.replace("costs", "errors"))
    (project / "cases/paper/tables").mkdir()
    (project / "cases/paper/tables/errors.csv").write_text("error\n1\n")
    write_readme("paper", None, project)
    assert not (project / "cases/paper/tables/costs.csv").exists()


def test_a_study_of_chains_alone_makes_no_table_of_beds(project: Path) -> None:
    (project / "cases/paper/README.md").write_text(MARKED.replace("costs", "cheaper_beds"))
    (project / "cases/paper/tables").mkdir()
    (project / "cases/paper/tables/cheaper_beds.csv").write_text("bed\nearlier\n")
    (project / "results/paper/tradeoff.csv").write_text("half,axis,variant,cost_s\nmcm,lag,,1\n")
    write_readme("paper", None, project)
    assert (project / "cases/paper/tables/cheaper_beds.csv").read_text() == "bed\nearlier\n"


def test_without_a_case_the_csv_file_decides(project: Path) -> None:
    write_readme("paper", None, project)
    file = project / "cases/paper/tables/costs.csv"
    file.write_text(file.read_text().replace("60 s", "61 s"))
    write_readme(None, None, project)
    assert "| 61 s |" in (project / "cases/paper/README.md").read_text()


def test_a_picture_is_a_smaller_copy_of_its_figure(project: Path) -> None:
    write_readme("paper", None, project)
    with Image.open(project / ".github/snapshot.png") as picture:
        assert picture.size == (PICTURE_WIDTH, 300)


def test_what_is_not_there_is_named(project: Path) -> None:
    with pytest.raises(UserError, match=r"no .*results/short/provenance.json: run the case first"):
        write_readme("short", None, project)
    with pytest.raises(UserError, match="study=peer: take one of verify, peers"):
        write_readme(None, "peer", project)
    with pytest.raises(UserError, match=r"no results/peers/peers.csv: run the study first"):
        write_readme(None, "peers", project)
    with pytest.raises(UserError, match="cases/paper/tables/costs.csv, which a mark names"):
        write_readme(None, None, project)
