# SPDX-License-Identifier: GPL-3.0-or-later
"""What to expect of a bed before it is simulated, as rows of a table: the bubbling two-phase model."""

import math

import pandas as pd

from bedchain.physics.bubbling_bed import BubblingBed, bubbling_bed
from bedchain.physics.scene_numbers import Scene
from bedchain.physics.two_phase import RegimeError

SOURCE = "bubbling two-phase model (Kunii, Levenspiel 1991), nothing fitted"


def expected_of(scene: Scene, line_m: float) -> pd.DataFrame:
    """Bubbles and height to expect of a bed of gas and particles.

    Parameters
    ----------
    scene : Scene
        Of `bedchain.case.scene.scene_of`.
    line_m : float
        Height that the share of particles below it is given for [m].

    Returns
    -------
    DataFrame
        quantity, symbol, value, unit, regime, source; without rows for a scene without gas. Outside the
        model's range one row without a value, whose regime and source say why.
    """
    columns = ["quantity", "symbol", "value", "unit", "regime", "source"]
    if not scene.gas:
        return pd.DataFrame(columns=columns)
    try:
        bed = bubbling_bed(scene)
    except RegimeError as error:
        rows = [("bubbling bed", "", math.nan, "", error.regime, f"refused: {error}")]
    else:
        rows = [(*row, f"{bed.regime} bubbles", SOURCE) for row in quantities(bed, line_m)]
    return pd.DataFrame(rows, columns=columns)


def quantities(bed: BubblingBed, line_m: float) -> list[tuple[str, str, float, str]]:
    """Name, symbol, value and unit of what the model says of a bed; `line_m` as of `expected_of`."""
    half = len(bed.height) // 2
    return [
        ("height of the bed", "H: integral of (1 - delta) dz = H_mf", bed.bed_height, "m"),
        ("mean particle height", "integral of z (1 - delta) dz / H_mf", bed.mean_height, "m"),
        (f"share below {line_m:g} m", "integral of (1 - delta) dz / H_mf", bed.share_below(line_m), "1"),
        ("bubble size at half height", "d_b of Darton", float(bed.bubble_diameter[half]), "m"),
        ("bubble size at the top", "d_b of Darton", float(bed.bubble_diameter[-1]), "m"),
        ("rise velocity at half height", "u - u_mf + u_br", float(bed.bubble_velocity[half]), "m/s"),
        ("bubble share at half height", "delta", float(bed.bubble_share[half]), "1"),
        ("circulation time", "H_mf / (f_w mean(delta u_b)), f_w = 0.25", bed.circulation_time, "s"),
    ]  # fmt: skip


def audit_rows(expected: pd.DataFrame) -> pd.DataFrame:
    """Rows of `expected_of` in the columns of ``audit.csv``; nothing is kept or dropped by them."""
    return pd.DataFrame(
        {
            "physics": "expected of the bed: " + expected["regime"],
            "number": expected["quantity"] + expected["unit"].map(lambda unit: f" [{unit}]" if unit else ""),
            "symbol": expected["symbol"],
            "value": expected["value"],
            "threshold": math.nan,
            "source": expected["source"],
            "decision": "expect",
            "built": "",
            "agrees": "",
        }
    )  # fmt: skip


def lines(expected: pd.DataFrame) -> list[str]:
    """The same as lines of text."""
    if expected.empty:
        return []
    if expected["value"].isna().any():
        return [f"what to expect of the bed: {expected['source'].iloc[0]}"]
    head = f"what to expect of the bed, {expected['regime'].iloc[0]}, by the {SOURCE}:"
    return [head, *(f"  {row.quantity}: {row.value:.3g} {row.unit}" for row in expected.itertuples())]
