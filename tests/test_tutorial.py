# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial: its cells run in order, and say what is stored beside them."""

import base64
import contextlib
import io
import json

import matplotlib
from matplotlib import pyplot as plt

from made import ROOT

TUTORIAL = ROOT / "tutorial.ipynb"
# figures and text of a page that is read in a browser
MOST_KB = 150


def stored(cell):
    """Text that a cell has printed."""
    return "".join("".join(part["text"]) for part in cell["outputs"] if part["output_type"] == "stream")


def test_the_cells_run_and_print_what_is_stored():
    cells = json.loads(TUTORIAL.read_text(encoding="utf-8"))["cells"]
    names: dict = {"__name__": "tutorial"}
    printed = []
    with matplotlib.rc_context({"backend": "Agg"}):
        for cell in cells:
            if cell["cell_type"] == "code":
                with contextlib.redirect_stdout(io.StringIO()) as text:
                    exec("".join(cell["source"]), names)  # noqa: S102
                assert text.getvalue() == stored(cell)
                printed.append(text.getvalue())
        drawn = len(plt.get_fignums())
        plt.close("all")
    pictures = [
        part["data"]["image/png"]
        for cell in cells
        for part in cell.get("outputs", [])
        if "image/png" in part.get("data", {})
    ]
    assert drawn == len(pictures) == 2 and sum(map(bool, printed)) == 4
    assert all(base64.b64decode(picture).startswith(b"\x89PNG") for picture in pictures)
    assert TUTORIAL.stat().st_size < 1000 * MOST_KB
