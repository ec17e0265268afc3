# SPDX-License-Identifier: GPL-3.0-or-later
"""Try solvers and chains at their extremes; write results/stability/stability.csv and stability maps.

usage: python scripts/study_stability.py
       python scripts/study_stability.py --extent reduced
       python scripts/study_stability.py --only gas_step velocity --folder /tmp/stability

Each verdict is kept in results/stability/kept: a study that was stopped goes on, and what is changed is tried
again. It ends with code 1 where a setting hangs or breaks with no guard to say why, after all are tried.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

import pandas as pd

from bedchain.errors import UserError, report_user_errors
from bedchain.files import write_csv
from bedchain.lifetime import end_with_run
from bedchain.rule_files import files_behind, source_files
from bedchain.studies.stability.bed_settings import bed_settings
from bedchain.studies.stability.chain_settings import chain_settings
from bedchain.studies.stability.maps import draw_maps
from bedchain.studies.stability.settings import StabilitySetting, chosen, is_of_chains
from bedchain.studies.stability.study import LONGEST_S, run_study
from bedchain.studies.stability.verdict import FAULTS

SOLVER = Path("results/bin/bedFoam")
FOLDER = Path("results/stability")
STABILITY = Path("scripts/bedchain/studies/stability")


def sources(settings: list[StabilitySetting]) -> dict[str, list[Path]]:
    """Files that the verdicts of each group depend on: the solvers' or the chains'."""
    decks = source_files("liggghts_inputs", "in.settle", "in.fluidize", "in.contact", "include/*.in")
    gas = source_files("openfoam_case", "0.orig/*", "constant/*", "system/*")
    beds = [str(SOLVER), "cases/case.schema.yaml", *decks, *gas]
    for name in ("bed_runs", "collisions"):
        beds += [str(STABILITY / f"{name}.py"), *files_behind(STABILITY / f"{name}.py")]
    chains: list[str] = []
    for name in ("chain_runs", "chain_settings"):
        chains += [str(STABILITY / f"{name}.py"), *files_behind(STABILITY / f"{name}.py")]
    files = {True: chains, False: beds}
    return {
        group: sorted(set(map(Path, files[is_of_chains(group)])))
        for group in {setting.group for setting in settings}
    }


def study_stability(folder: Path, extent: str, only: list[str], longest_s: float) -> pd.DataFrame:
    """Try the settings that are asked for; write the table and the maps."""
    if not SOLVER.exists():
        raise UserError(f"there is no solver {SOLVER}: run snakemake build_solver")
    settings = chosen([*chain_settings(), *bed_settings()], only, extent == "reduced")
    table = run_study(settings, folder, sources(settings), partial(print, flush=True), longest_s)
    draw_maps(table, folder / "figures")
    write_csv(table, folder / "stability.csv")
    return table


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--extent", choices=("full", "reduced"), default="full", help="reduced: a minute (default full)"
    )
    parser.add_argument("--only", nargs="+", default=[], metavar="GROUP", help="groups of settings")
    parser.add_argument("--folder", type=Path, default=FOLDER, help=f"for all results (default {FOLDER})")
    parser.add_argument(
        "--longest", type=float, default=LONGEST_S, help=f"wall time of a setting [s] (default {LONGEST_S:g})"
    )
    given = parser.parse_args()
    end_with_run()
    with report_user_errors():
        table = study_stability(given.folder, given.extent, given.only, given.longest)
    for outcome, number in table.groupby("guards")["outcome"].value_counts().items():
        print(f"guards {outcome[0]}: {number} {outcome[1]}")
    faults = table[table["outcome"].isin(FAULTS)]
    for row in faults.itertuples():
        print(f"{row.setting}: {row.outcome}: {row.reason}")
    return 1 if len(faults) else 0


if __name__ == "__main__":
    sys.exit(main())
