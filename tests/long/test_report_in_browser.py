# SPDX-License-Identifier: GPL-3.0-or-later
"""The report in a browser without a network: every picture and film is shown.

``pytest tests/long/test_report_in_browser.py`` opens a small one, and that of ``./run``.
"""

import json
import re
import subprocess
from types import SimpleNamespace

import matplotlib.image
import numpy as np
import pytest
from matplotlib import pyplot as plt

from bedchain.figures.report import bed_section, report_page
from made import ROOT
from made.browser import chromium, opened
from made.drawings import LEAST_INK
from make_film import write_film

# what the browser has made of the pictures and films, written into the page that it shows
ASKED = """<script>
addEventListener("load", () => setTimeout(() => {
  const seen = [...document.images].map((image) => image.naturalWidth);
  const films = [...document.querySelectorAll("video")].map((film) => film.videoWidth);
  document.body.dataset.shown = JSON.stringify([seen, films]);
}, 5000));
</script></body>"""


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    try:
        return chromium(tmp_path_factory.mktemp("chromium"))
    except (OSError, subprocess.SubprocessError) as error:
        pytest.skip(f"Chromium cannot be had: {error}")


def shown_of(browser, page, tmp_path):
    """Widths of pictures and of films as the browser has them, and the picture of the first screen."""
    asked, screen = tmp_path / "asked.html", tmp_path / "screen.png"
    asked.write_text(page.replace("</body>", ASKED), encoding="utf-8")
    elements = opened(browser, asked, screen)
    answer = re.search(r'data-shown="([^"]*)"', elements)
    assert answer, elements[-500:]
    widths, films = json.loads(answer[1].replace("&quot;", '"'))
    assert (matplotlib.image.imread(screen)[..., :3].min(axis=2) < 0.9).mean() > LEAST_INK
    return SimpleNamespace(pictures=widths, films=films)


def test_a_small_report_shows_its_picture_and_its_film(browser, tmp_path):
    folder = tmp_path / "small"
    (folder / "figures").mkdir(parents=True)
    plt.figure(figsize=(2, 1)).savefig(folder / "figures" / "fig1.png", dpi=100)
    write_film(folder / "figures" / "film.mp4", (48, 64), [np.full((48, 64, 3), 99, np.uint8)] * 3)
    case = {"values": {"title": "small"}}
    record = {"case": case, "git": {"commit": None}, "machine": {"processor": "a processor", "cores": 2}}
    (folder / "provenance.json").write_text(json.dumps(record))
    (folder / "table1.html").write_text("<table><tr><td>drag law</td></tr></table>")
    (folder / "metrics.csv").write_text("quantity,source,value\nnoise_floor_left,dem,0.04\n")
    (folder / "caption.rst").write_text("A caption.")
    files = [folder / "figures" / name for name in ("fig1.png", "film.mp4")]
    page = report_page([bed_section(folder, {".*": folder / "caption.rst"}, files)])
    shown = shown_of(browser, page, tmp_path)
    assert shown.pictures == [200] and shown.films == [64]
    broken = re.sub(r"base64,[^\"]{40}", "base64,", page)
    assert shown_of(browser, broken, tmp_path).pictures == [0]


@pytest.mark.skipif(not (ROOT / "results/report.html").exists(), reason="./run made no results/report.html")
def test_the_report_of_the_run_shows_everything(browser, tmp_path):
    page = (ROOT / "results/report.html").read_text(encoding="utf-8")
    shown = shown_of(browser, page, tmp_path)
    held = len(re.findall(r"<img ", page)), len(re.findall(r"<video ", page))
    assert (len(shown.pictures), len(shown.films)) == held and min(held) > 0
    assert min(shown.pictures) > 0 and min(shown.films) > 0
