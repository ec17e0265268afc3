# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a bed by the real solvers, and their verdicts."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

from bedchain.case.parameters import weight_per_area
from bedchain.case.schema import Case
from bedchain.case.variants import Variant
from bedchain.dem.variant_run import simulate
from bedchain.errors import CaseError, UserError
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.studies.stability.beds import StabilityBed, case_of, changes
from bedchain.studies.stability.verdict import Verdict, judge, refused, stopped
from bedchain.studies.verification.rows import Row

ROUND_OFF = 1e-10  # relative, of sums over some hundred particles
VOLUME_BALANCE = 1e-5  # of a gas cell's volume a step, by the pressure solver's tolerance
AT_REST = 0.02  # kinetic energy of a particle over m g d: a hundredth of a fall over its diameter, twice
CARRIED, CARRIED_MOVING = 0.05, 0.25  # share of the weight; a tiny bed in motion is thrown up and down
HEIGHT, HEIGHT_MOVING = 0.1, 0.4  # relative, of the mean height: loose and dense beds differ by 7 %
GAS_SHARE = 0.05  # relative, of the weight that the gas carries: the same packing
NOT_OURS = re.compile(r"is not installed|MB are free|is in use by process")


@dataclass(frozen=True)
class Expected:
    """Expected outcome of a run.

    Attributes
    ----------
    moving : bool
        Whether the bed moves; then only the weight carried and the height are checked, with wide tolerances.
    overlap : float
        Largest overlap of a bed at rest by theory, over the diameter [1]; 0 where the bed moves.
    reference : str
        Name of the setting whose mean height and gas share this one must have; empty for none.
    share_tolerance : float
        Relative, of the gas share.
    height_m : float
        Mean height by theory [m]; 0 for none.
    """

    moving: bool = False
    overlap: float = 0.0
    reference: str = ""
    share_tolerance: float = GAS_SHARE
    height_m: float = 0.0


def run_bed(
    folder: Path, bed: StabilityBed, expected: Expected, known: Mapping[str, Mapping[str, float]]
) -> Verdict:
    """Simulate a bed to its end and judge it.

    Parameters
    ----------
    folder : Path
        To work in.
    bed : StabilityBed
    expected : Expected
    known : mapping of str to mapping
        Observed values of other settings.

    Returns
    -------
    Verdict

    Raises
    ------
    UserError
        A program is not installed, the disk is full, or another study is running: not due to the setting.
    """
    folder.mkdir(parents=True, exist_ok=True)
    plain = folder / "plain.yaml"
    plain.write_text(yaml.safe_dump(case_of(StabilityBed()), sort_keys=False), encoding="utf-8")
    try:
        case = simulate(plain, Variant(folder.name, changes(bed)), folder, bed.ranks)
    except CaseError as error:
        return refused(error)
    except UserError as error:
        if NOT_OURS.search(str(error)):
            raise
        log = folder / "simulate.log"
        text = log.read_text(encoding="utf-8", errors="replace") if log.exists() else ""
        return stopped(f"{text} {error}")
    observed = observe(case, pd.read_csv(folder / "bed_series.csv"))
    return judge(checks(observed, expected, known.get(expected.reference, {})), observed)


def observe(case: Case, series: pd.DataFrame) -> dict[str, float]:
    """Observed values of a run, most of them over its second half.

    Parameters
    ----------
    case : dict
        A checked case.
    series : DataFrame
        bedFoam's bed_series.csv.

    Returns
    -------
    dict of str to float
        By name and unit; NaN where the series has one.
    """
    late = series[series["time_s"] >= case["time"]["end_s"] / 2]
    particles = case["particles"]
    mass = particles["density_kg_m3"] * np.pi / 6 * particles["diameter_m"] ** 3
    energy = particles["number"] * mass * GRAVITY_M_S2 * particles["diameter_m"]
    parts = ("weight_on_gas_1", "weight_on_floor_1", "weight_on_sides_1")
    means = late.mean(skipna=False)
    values = {
        "height_m": means["mean_height_m"],
        "carried_1": sum(means[part] for part in parts),
        "momentum_1": momentum(late),
        "gas_share_1": means["weight_on_gas_1"],
        "drop_1": means["pressure_drop_Pa"] / weight_per_area(case),
        "kinetic_1": means["kinetic_energy_J"] / energy,
        "overlap_1": series["largest_overlap_1"].max(skipna=False),
        "balance_1": series["volume_balance_1"].abs().max(skipna=False),
        "exchange_1": series["exchange_error_1"].abs().max(skipna=False),
        "clips_1": series["voidage_clips_1"].max(skipna=False),
        "lost_1": particles["number"] - series["particles_1"].min(skipna=False),
    }
    return {name: float(value) for name, value in values.items()}


def momentum(series: pd.DataFrame) -> float:
    """Share of the weight to be carried, ``1 + a / g`` with the mean acceleration of the centre [1]."""
    times, heights = series["time_s"].to_numpy(), series["mean_height_m"].to_numpy()
    speeds, middles = np.diff(heights) / np.diff(times), (times[1:] + times[:-1]) / 2
    return float(1 + (speeds[-1] - speeds[0]) / (middles[-1] - middles[0]) / GRAVITY_M_S2)


def checks(observed: Mapping[str, float], expected: Expected, reference: Mapping[str, float]) -> list[Row]:
    """Checks of a run that came to its end.

    Parameters
    ----------
    observed : mapping of str to float
        Of `observe`.
    expected : Expected
    reference : mapping of str to float
        Observed values of the setting that it is compared with; empty for none.
    """
    moving = expected.moving
    rows = [
        Row("lost particles [1]", observed["lost_1"], 0, 0.5, "no particle may vanish"),
        Row("gas balance over a cell [1]", observed["balance_1"], 0, VOLUME_BALANCE, "closed balance"),
        Row("error of the exchange [1]", observed["exchange_1"], 0, ROUND_OFF, "drag on gas and particles"),
        Row("gas cells with a raised voidage [1]", observed["clips_1"], 0, 0.5, "no bed is so dense"),
        Row(
            "weight carried by gas, floor and sides [1]", observed["carried_1"], observed["momentum_1"],
            CARRIED_MOVING if moving else CARRIED, "Newton's second law",
        ),
    ]  # fmt: skip
    if not moving:
        rows.append(Row("kinetic energy over m g d [1]", observed["kinetic_1"], 0, AT_REST, "bed at rest"))
    if expected.overlap:
        source = "Hertz: 3 x at rest, or a fall of one diameter"
        rows.append(Row("deepest overlap over d [1]", observed["overlap_1"], 0, expected.overlap, source))
    if expected.height_m:
        rows.append(Row("mean height [m]", observed["height_m"], expected.height_m, HEIGHT, "geometry"))
    if expected.reference:
        # NaN where that setting did not end: the check fails then
        tolerance = HEIGHT_MOVING if moving else HEIGHT
        height = reference.get("height_m", np.nan)
        source = f"as in {expected.reference}"
        rows.append(Row("mean height [m]", observed["height_m"], height, tolerance, source))
        if not moving and reference.get("gas_share_1", 0) > AT_REST:
            shares = observed["gas_share_1"], reference["gas_share_1"]
            rows.append(Row("weight on the gas [1]", *shares, expected.share_tolerance, source))
    return rows
