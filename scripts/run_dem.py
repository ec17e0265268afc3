# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate a case in restartable segments: settle without gas, then ramp the gas, or turn the drum, and run.

usage: python scripts/run_dem.py results/short --end 5 --segment 0.25 --ranks 2
       python scripts/run_dem.py results/short --end 5 --segment 0.25 --ranks auto --start 3 --repeat 1

The state is in results/<case>/dem/<stamp of the inputs>/. Killed at any time, the same command goes on from
the last finished segment; other inputs get a folder of their own, so earlier results stay. At the end it
writes dem.json (all frames) and bed_series.csv (pressure drop, bed height, conservation) into results/<case>.

A repeat is another realisation: it takes the finished run's particles and gas at --start, changes each
velocity a little, and goes on to --end in results/<case>/repeats/<N>/, which gets the same files.
"""

import argparse
from pathlib import Path

from bedchain.case.rank_checks import cores_here
from bedchain.dem.free_ranks import ranks_of
from bedchain.dem.run import repeat_dem, run_dem
from bedchain.dem.segments import read_parameters
from bedchain.errors import report_user_errors
from bedchain.lifetime import end_with_run


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="results/<case>, with parameters.lig and caseParameters")
    parser.add_argument("--end", type=float, required=True, help="simulated time at the end [s]")
    parser.add_argument("--segment", type=float, required=True, help="simulated time of a segment [s]")
    parser.add_argument(
        "--ranks", default="1", help="MPI ranks, or auto: as many as cores are free (default 1)"
    )
    parser.add_argument("--cores", type=int, default=cores_here(), help="cores that auto may take")
    parser.add_argument("--repeat", type=int, metavar="N", help="make the N-th repeat of the finished run")
    parser.add_argument("--start", type=float, help="where a repeat starts [s], the end of a segment")
    given = parser.parse_args()
    if (given.repeat is None) != (given.start is None):
        parser.error("--repeat and --start belong together")
    end_with_run()
    with report_user_errors():
        ranks = ranks_of(given.ranks, given.cores, read_parameters(given.folder / "parameters.lig"))
        if given.repeat is None:
            run_dem(given.folder, given.end, given.segment, ranks)
        else:
            repeat_dem(given.folder, given.start, given.end, given.segment, ranks, given.repeat)


if __name__ == "__main__":
    main()
