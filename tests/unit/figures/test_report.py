# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: one file that holds every picture, and shows texts as they are."""

import base64
import json
import re

import pandas as pd
import pytest

from bedchain.figures.report import bed_section, claims_table, embedded, outcome_table, report_page

PICTURE = b"\x89PNG no real one"
METRICS = pd.DataFrame(
    {
        "quantity": ["error_rms_left", "noise_floor_left", "pressure_drop_over_weight", "particles"],
        "source": ["static", "dem", "dem", "dem"],
        "value": [0.1051, 0.039, 0.975, 81000],
    }
)


@pytest.fixture
def bed(tmp_path):
    """Results of a bed as far as the report reads them, and their captions."""
    folder = tmp_path / "small"
    (folder / "figures").mkdir(parents=True)
    for name in ("fig1_cells.png", "film.mp4"):
        (folder / "figures" / name).write_bytes(PICTURE)
    record = {
        "case": {"values": {"title": "a <small> bed"}}, "git": {"commit": None},
        "machine": {"processor": "a processor", "cores": 2},
    }  # fmt: skip
    (folder / "provenance.json").write_text(json.dumps(record))
    (folder / "table1.html").write_text("<table><tr><td>drag law</td></tr></table>")
    METRICS.to_csv(folder / "metrics.csv", index=False)
    captions = {"fig1_(cells|rings)": tmp_path / "cells.rst", "film": tmp_path / "film.rst"}
    for name, file in captions.items():
        file.write_text(f"Caption of {name} & more.\n")
    return folder, captions


def test_the_page_holds_all_pictures_and_needs_no_other_file(bed):
    folder, captions = bed
    figures = [folder / "figures" / name for name in ("fig1_cells.png", "film.mp4")]
    page = report_page([bed_section(folder, captions, figures)])
    held = re.findall(r'src="data:(image/png|video/mp4);base64,([^"]*)"', page)
    assert [kind for kind, _ in held] == ["image/png", "video/mp4"]
    assert all(base64.b64decode(data) == PICTURE for _, data in held)
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    assert "a &lt;small&gt; bed" in page and "film &amp; more" in page and "<td>drag law</td>" in page
    assert "no commit" in page and "0.105" in page and "noise floor" in page


def test_a_figure_without_a_caption_is_refused(bed):
    folder, captions = bed
    with pytest.raises(KeyError, match="film has no caption"):
        embedded(folder / "figures" / "film.mp4", {"fig1_cells": captions["film"]})


def test_a_bed_without_metrics_shows_what_is_left_out(bed):
    folder, captions = bed
    left_out = pd.DataFrame(
        {"product": ["mixing.csv, metrics.csv, film.mp4"], "reason": ["they leave the bed"]}
    )
    left_out.to_csv(folder / "left_out.csv", index=False)
    (folder / "metrics.csv").unlink()
    assert "they leave the bed" in bed_section(folder, captions, [])["outcome"]


def test_metrics_that_matter_stand_by_group(bed):
    text = outcome_table(bed[0] / "metrics.csv")
    assert "81000" not in text
    assert text.index("noise floor") < text.index("pressure drop") < text.index("rms error")


def test_the_paper_s_numbers_stand_beside_ours_with_units(tmp_path):
    claims = pd.DataFrame(
        {"claim": ["5 s take 20 h"], "where": ["section 3"], "paper": [20.0], "ours": [0.5964], "unit": ["h"],
         "within": ["no"], "why": ["another machine"]}
    )  # fmt: skip
    claims.to_csv(tmp_path / "agreement.csv", index=False)
    text = claims_table(tmp_path / "agreement.csv")
    assert all(
        f"<td>{words}</td>" in text for words in ("5 s take 20 h", "20 h", "0.596 h", "another machine")
    )
