# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables between marks in a README, each from a csv file::

<!-- table: cases/paper/tables/errors.csv -->
...
<!-- end -->
"""

import re
from pathlib import Path

import pandas as pd

from bedchain.errors import UserError

MARKED = re.compile(r"<!-- table: (?P<file>\S+) -->\n.*?<!-- end -->", re.DOTALL)
OPENING, CLOSING = "<!-- table:", "<!-- end -->"
# columns that say where a row is from: they stand below the table
ORIGIN = ["machine", "commit", "source"]


def named_files(text: str) -> list[str]:
    """The csv files that a text shows, in their order, by their paths from the project's root."""
    return [match["file"] for match in MARKED.finditer(text)]


def filled(text: str, root: Path) -> str:
    """A text with each table between marks as its csv file has it.

    Parameters
    ----------
    text : str
    root : Path
        Folder that the marks' paths start from.

    Raises
    ------
    UserError
        A mark is not closed, there is no such file, or a row of it is longer than its first line.
    """
    if not text.count(OPENING) == text.count(CLOSING) == len(named_files(text)):
        raise UserError(f"a table lacks one of its marks, {OPENING} FILE --> and {CLOSING}")
    return MARKED.sub(lambda match: _block(match["file"], root), text)


def markdown(table: pd.DataFrame) -> str:
    """A table of texts in markdown, with the origin of its rows below it."""
    shown = table.drop(columns=ORIGIN, errors="ignore")
    lines = [list(shown.columns), ["---"] * shown.shape[1], *shown.to_numpy().tolist()]
    rows = ["| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |" for cells in lines]
    return "\n".join([*rows, *_origins(table)])


def _block(file: str, root: Path) -> str:
    path = root / file
    if not path.exists():
        raise UserError(f"there is no {file}, which a mark names")
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    if not isinstance(table.index, pd.RangeIndex):  # pandas takes the first field of longer rows for a name
        raise UserError(f"{file} has rows longer than its first line: put what has a comma into quotes")
    return f"{OPENING} {file} -->\n{markdown(table)}\n{CLOSING}"


def _origins(table: pd.DataFrame) -> list[str]:
    known = table.reindex(columns=ORIGIN, fill_value="").drop_duplicates()
    said = []
    for machine, commit, source in known.itertuples(index=False):
        words = [machine, f"commit {commit}" if commit else "", source]
        said.append(", ".join(filter(None, words)))
    return ["", f"<sub>{'; '.join(said)}</sub>"] if any(said) else []
