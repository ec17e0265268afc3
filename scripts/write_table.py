# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1: the values that set the bed and its chains, as csv, html and LaTeX."""

from pathlib import Path
from typing import Any

from bedchain.case.schema import load_schema
from bedchain.comparison.table1 import table_of_values
from bedchain.files import write_csv, write_text
from bedchain.stage import run_stage


def write_table(
    schema: Path, csv: Path, html: Path, tex: Path, values: dict[str, Any], with_paper: bool
) -> None:
    """Write Table 1 in three forms.

    Parameters
    ----------
    schema : Path
        ``case.schema.yaml``, with the paper's values.
    csv, html, tex : Path
        Tables to make; the csv has the keys of the case file too.
    values : dict of str to value
        Dotted key to value of the case.
    with_paper : bool
        Whether the case is the paper's bed: then the paper's values stand beside it.
    """
    table = table_of_values(values, load_schema(schema), with_paper)
    write_csv(table, csv)
    shown = table.drop(columns="key").rename(columns={"this_case": "this case"})
    write_text(html, shown.to_html(index=False, border=0) + "\n")
    latex = shown.style.hide(axis="index").format(escape="latex")
    write_text(tex, latex.to_latex(hrules=True, column_format="l" * shown.shape[1]))


if rule := globals().get("snakemake"):
    run_stage(write_table, rule)
