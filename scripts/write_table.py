# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1: every value of the case beside the paper's, with its unit and where it is from."""

import re
import textwrap
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from bedchain.case.schema import load_schema
from bedchain.comparison.table1 import table_of_values
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

# "Inner width along x [m]. Table 1 (0.27 m)." -> name, unit, note
DESCRIPTION = re.compile(r"(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]\s*[.,;:]?\s*(?P<note>.*)", re.DOTALL)
COLUMNS_IN = {"parameter": 0.0, "paper": 2.5, "this case": 3.1, "unit": 3.75, "note": 4.25}
WRAP = {"parameter": 52, "note": 60}
LINE_IN = 0.098
GAP_IN = 0.065
FONT_SIZE = 5.6


def write_table(schema: Path, files: FigureFiles, values: dict[str, Any]) -> None:
    """Write Table 1 as numbers and as a picture.

    Parameters
    ----------
    schema : Path
        ``case.schema.yaml``: meaning, unit and source of each key, and the paper's value.
    files : FigureFiles
        The table as a figure; its csv gets section, parameter, paper, this_case, unit, note, key.
    values : dict of str to value
        Dotted key to value of the case.
    """
    rows = table_rows(table_of_values(values, load_schema(schema)))
    write_csv(rows, files.csv)
    with figure_style(), plt.rc_context({"figure.constrained_layout.use": False}):
        files.save(_drawn(rows))


def table_rows(values: pd.DataFrame) -> pd.DataFrame:
    """Meanings taken apart into parameter, unit and note.

    Parameters
    ----------
    values : DataFrame
        Of `bedchain.table.table_of_values`.

    Returns
    -------
    DataFrame
        section, parameter, paper, this_case, unit, note, key; a dash where the paper gives nothing.
    """
    rows = []
    for row in values.itertuples():
        meaning = " ".join(str(row.meaning).split())
        found = DESCRIPTION.fullmatch(meaning)
        name, unit, note = found.group("name", "unit", "note") if found else (meaning, "", "")
        section = str(row.key).partition(".")[0]
        paper = row.paper_value if row.paper_value != "" else "-"
        rows.append((section, name, paper, row.value, unit, note[:1].upper() + note[1:], row.key))
    return pd.DataFrame(rows, columns=["section", "parameter", "paper", "this_case", "unit", "note", "key"])


def _drawn(rows: pd.DataFrame) -> Figure:
    texts = []
    for row in rows.itertuples():
        name, note = (textwrap.fill(str(getattr(row, of)), width) for of, width in WRAP.items())
        texts.append((row.section, name, row.paper, row.this_case, row.unit, note))
    lines = [1 + max(name.count("\n"), note.count("\n")) for _, name, *_, note in texts]
    height = (
        sum(lines) * LINE_IN + len(texts) * GAP_IN + rows["section"].nunique() * (LINE_IN + 2 * GAP_IN) + 0.4
    )
    figure = plt.figure(figsize=(DOUBLE_COLUMN_IN, height))
    axes = figure.add_axes((0.01, 0.0, 0.98, 1.0))
    axes.set(xlim=(0, 0.98 * DOUBLE_COLUMN_IN), ylim=(height, 0))
    axes.axis("off")
    at = 0.18
    for title, x in COLUMNS_IN.items():
        axes.text(x, at, title, fontsize=FONT_SIZE + 0.7, weight="bold", va="center")
    axes.axhline(at + 0.09, color="black", linewidth=0.8)
    at += 0.14
    section = None
    for (of, name, paper, value, unit, note), n_lines in zip(texts, lines, strict=True):
        if of != section:
            at += GAP_IN
            axes.text(0, at, of, fontsize=FONT_SIZE, weight="bold", style="italic", va="top", color="#555555")
            at, section = at + LINE_IN + GAP_IN, of
        for x, text in zip(COLUMNS_IN.values(), (name, paper, value, unit, note), strict=True):
            axes.text(x, at, str(text).replace("$", r"\$"), fontsize=FONT_SIZE, va="top", linespacing=1.25)
        at += n_lines * LINE_IN + GAP_IN
    axes.axhline(at, color="black", linewidth=0.8)
    return figure


if rule := globals().get("snakemake"):
    run_stage(write_table, rule)
