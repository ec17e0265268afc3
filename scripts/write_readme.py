# SPDX-License-Identifier: GPL-3.0-or-later
"""The measured tables and the pictures of the README files.

usage: python scripts/write_readme.py [--case short] [--study verify]

Tables stand between marks and come from committed csv files, which this writes into the texts. Before that,
the csv files of a case are made from its results, and that of a study from what it has just left on this
machine, at the commit that is checked out.
"""

import argparse
from collections.abc import Callable
from pathlib import Path

import pandas as pd
from PIL import Image

from bedchain.errors import UserError
from bedchain.files import atomic_file, write_csv, write_text
from bedchain.stage import LOG, known_files, stage
from bedchain.studies.readme import case_tables, study_tables
from bedchain.studies.readme.marks import filled, named_files
from bedchain.studies.readme.origins import origin_now, origin_of_case, with_origin

READMES = ("README.md", "*/README.md", "cases/*/README.md")
PICTURE_WIDTH = 1400  # pixels
Builder = Callable[[Path], pd.DataFrame]
# csv file in cases/<case>/tables -> the results that it needs, and the function that makes it
OF_CASE: dict[str, tuple[tuple[str, ...], Builder]] = {
    "summary": (("agreement.csv", "metrics.csv", "discussion.csv"), case_tables.summary),
    "errors": (("metrics.csv",), case_tables.errors),
    "bed": (("dem.json", "bed_series.csv"), case_tables.bed),
    "costs": (("timing.csv",), case_tables.costs),
    "agreement": (("agreement.csv",), case_tables.agreement),
    "steadiness": (("stationarity.csv",), case_tables.steadiness),
    "ladder": (("ladder.csv",), case_tables.ladder),
    "cells_and_lags": (("discussion.csv",), case_tables.cells_and_lags),
    "preset_errors": (("preset_errors.csv",), study_tables.preset_errors),
    "tradeoff_mixing": (("tradeoff.csv",), study_tables.mixing_by_cell_and_lag),
    "tradeoff_density": (("tradeoff.csv",), study_tables.density_by_cell_and_lag),
    "learning_windows": (("tradeoff.csv",), study_tables.learning_windows),
    "variants": (("figures/fig_tradeoff_dem.csv",), study_tables.variants),
    # a study of chains alone has no beds, and makes no figure of them
    "cheaper_beds": (("tradeoff.csv", "figures/fig_tradeoff_dem.csv"), study_tables.cheaper_beds),
    "scores": (("scores.csv",), study_tables.scores),
    "validation": (("validation_metrics.csv",), study_tables.validation),
}
# study -> its results, the csv file, and the function that makes it
OF_STUDY: dict[str, tuple[str, str, Builder]] = {
    "verify": (
        "results/verify/verification.csv",
        "openfoam_case/tables/verification.csv",
        study_tables.verification,
    ),
    "peers": ("results/peers/peers.csv", "openfoam_case/tables/peers.csv", study_tables.peers),
    "stability": (
        "results/stability/stability.csv",
        "openfoam_case/tables/stability.csv",
        study_tables.stability,
    ),
    "benchmark_core": (
        "results/benchmark_core.csv",
        "scripts/tables/benchmark_core.csv",
        study_tables.benchmark,
    ),
    "bands": ("results/bands/coverage.csv", "scripts/tables/coverage.csv", study_tables.coverage),
}
# picture in .github -> the figure that it is a smaller copy of
PICTURES = {
    "snapshot": "results/paper/figures/snapshot.png",
    "ladder": "results/paper/figures/fig_ladder.png",
    "tradeoff": "results/short/figures/fig_tradeoff.png",
    "tradeoff_dem": "results/short/figures/fig_tradeoff_dem.png",
}


def write_readme(case: str | None, study: str | None, root: Path = Path()) -> None:
    """Make the csv files of a case or a study from results, where one is named; then every table.

    Parameters
    ----------
    case : str, optional
        With results in ``results/<case>``; its pictures are made as well.
    study : str, optional
        A key of `OF_STUDY` that was run on this machine.
    root : Path
        The project's folder.

    Raises
    ------
    UserError
        The results are not there, or a mark is not closed or names no file.
    """
    if case:
        tables_of_case(case, root)
        for name, figure in PICTURES.items():
            if figure.startswith(f"results/{case}/") and (root / figure).exists():
                copy_picture(root / figure, root / f".github/{name}.png")
    if study:
        table_of_study(study, root)
    for readme in readmes(root):
        text = readme.read_text(encoding="utf-8")
        if (new := filled(text, root)) != text:
            write_text(readme, new)
            LOG.info("%s: tables written", readme)


def tables_of_case(case: str, root: Path) -> None:
    """Make the csv files that a README shows and whose results are there; the others stay as they are."""
    results = root / "results" / case
    origin = origin_of_case(results)
    shown = {file for readme in readmes(root) for file in named_files(readme.read_text(encoding="utf-8"))}
    for name, (needed, build) in OF_CASE.items():
        target = f"cases/{case}/tables/{name}.csv"
        if target in shown and all((results / file).exists() for file in needed):
            write_csv(with_origin(build(results), origin), root / target)
            LOG.info("%s, commit %s", target, origin["commit"])


def readmes(root: Path) -> list[Path]:
    """The README files that hold measured tables."""
    return sorted(file for pattern in READMES for file in root.glob(pattern))


def table_of_study(study: str, root: Path) -> None:
    """Make the csv file of a study that was run on this machine at this commit."""
    if study not in OF_STUDY:
        raise UserError(f"--config study={study}: take one of {', '.join(OF_STUDY)}")
    results, target, build = OF_STUDY[study]
    if not (root / results).exists():
        raise UserError(f"there is no {results}: run the study first")
    write_csv(with_origin(build((root / results).parent), origin_now()), root / target)


def copy_picture(figure: Path, target: Path) -> None:
    """Copy a figure at the size of a README."""
    with Image.open(figure) as picture:
        width = min(PICTURE_WIDTH, picture.width)
        small = picture.convert("RGB").resize((width, round(picture.height * width / picture.width)))
    with atomic_file(target) as temporary:
        small.quantize(256).save(temporary, optimize=True)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--case", help="make its csv files from results/<case>")
    parser.add_argument("--study", help=f"make its csv file, of {', '.join(OF_STUDY)}")
    parser.add_argument("--log", type=Path, default=Path("logs/write_readme.log"), help="log file")
    given = parser.parse_args()
    results = Path("results") / (given.case or "none")
    with stage(given.log), known_files(sorted([*results.glob("*.csv"), *results.glob("*.json")]), []):
        write_readme(given.case, given.study)


if __name__ == "__main__":
    main()
