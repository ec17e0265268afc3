# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated profiles at the points of a measured bed, and their differences from the measurement.

The box is symmetric, so that a simulated profile is averaged with its mirror image, which halves its noise.
The measurement is no ruler either: `measurement_metrics` says how far it is from its own mirror image.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.measures.slices import QUANTITIES, Boxes, boxes_around, profile, solids_in_boxes
from bedchain.uncertainty.bands import block_band, means_left_out

STRIP_M = 1.9e-3  # width of a strip: the distance of measured points across the bed
SLICE_M = 4e-3  # height of a slice: about three particles, short against the distance of measured heights
ACROSS = 400  # positions over which the solids flux is averaged
POINT_COLUMNS = ("quantity", "height_m", "position_x_m", "value")


class BedFrames(NamedTuple):
    """Frames and dimensions from which profiles are made.

    Attributes
    ----------
    frames : (n_frames, 4, n_particles) ndarray
        x, z [m], vx, vz [m/s] over a window of time.
    interval_s : float
        Between frames [s].
    radius_m, width_m, depth_m : float
        Of a particle, of the bed along x and y [m].
    """

    frames: np.ndarray
    interval_s: float
    radius_m: float
    width_m: float
    depth_m: float


def simulated(
    bed: BedFrames, quantity: str, height_m: float, x_m: np.ndarray
) -> tuple[pd.DataFrame, np.ndarray]:
    """Profile across the bed, averaged with its mirror image; 95 % band by leaving out blocks of frames.

    Parameters
    ----------
    bed : BedFrames
    quantity : str
        Of `QUANTITIES`.
    height_m : float
        Middle of the slice [m].
    x_m : (n_positions,) ndarray
        Middles of the strips [m].

    Returns
    -------
    table : DataFrame
        quantity, height_m, position_x_m, simulated, ci_low, ci_high.
    left_out : (BLOCKS, n_positions) ndarray
        Without each block of frames, in the quantity's unit.
    """
    sides = np.concatenate([x_m, bed.width_m - x_m])
    both = boxes_around(sides, STRIP_M, height_m, SLICE_M, bed.width_m, bed.depth_m)
    solids = np.stack([solids_in_boxes(x, z, vz, bed.radius_m, both) for x, z, _, vz in bed.frames])
    solids = (solids[..., : len(x_m)] + solids[..., len(x_m) :]) / 2
    boxes = boxes_around(x_m, STRIP_M, height_m, SLICE_M, bed.width_m, bed.depth_m)
    value, left_out = profile_left_out(quantity, solids, boxes)
    low, high = block_band(value, left_out)
    names = {"quantity": quantity, "height_m": height_m, "position_x_m": x_m}
    return pd.DataFrame(names | {"simulated": value, "ci_low": low, "ci_high": high}), left_out


def compare(points: pd.DataFrame, bed: BedFrames) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Simulated values at the measured points, and their differences from them.

    Parameters
    ----------
    points : DataFrame
        Of `read_points`.
    bed : BedFrames

    Returns
    -------
    table : DataFrame
        quantity, height_m, position_x_m, measured, simulated, ci_low, ci_high.
    metrics : DataFrame
        Of `difference_metrics`, over all points of a quantity and for each height.
    """
    tables, metrics = [], []
    for quantity, of_quantity in points.groupby("quantity", sort=False):
        parts = []
        for height, at in of_quantity.groupby("height_m"):
            table, left_out = simulated(bed, quantity, height, at["position_x_m"].to_numpy())
            table.insert(3, "measured", at["value"].to_numpy())
            parts.append((f"_{1e3 * height:g}_mm", table, left_out))
        together = pd.concat([table for _, table, _ in parts]), np.hstack([without for *_, without in parts])
        name, unit = QUANTITIES[quantity]
        for where, table, left_out in [("", *together), *parts]:
            values = table["simulated"].to_numpy(), left_out, table["measured"].to_numpy()
            metrics += difference_metrics(name + where, unit, *values)
        tables.append(together[0])
    return pd.concat(tables, ignore_index=True), pd.DataFrame(metrics)


def measurement_metrics(points: pd.DataFrame, width_m: float) -> pd.DataFrame:
    """How far the measurement is from what it must be: symmetric, and as many solids down as up.

    Parameters
    ----------
    points : DataFrame
        Of `read_points`.
    width_m : float
        Of the bed [m].

    Returns
    -------
    DataFrame
        quantity, source, value, unit: rms of half the difference of a profile and its mirror image, and the
        mean over the width of (1 - voidage) velocity at each height of the velocity, beside the mean of its
        size. The voidage is that of the nearest height.
    """
    rows = []
    voidages = dict(list(points[points["quantity"] == "voidage_1"].groupby("height_m")))
    for quantity, of_quantity in points.groupby("quantity", sort=False):
        name, unit = QUANTITIES[quantity]
        halves = [half_difference(at, width_m) for _, at in of_quantity.groupby("height_m")]
        rows.append((f"{name}_asymmetry_rms", float(rms(np.concatenate(halves))), unit))
    across = np.linspace(0, width_m, ACROSS)
    for height, at in points[points["quantity"] == "particle_velocity_m_s"].groupby("height_m"):
        if not voidages:
            break
        nearest = voidages[min(voidages, key=lambda other: abs(other - height))]
        flux = (1 - interpolated(nearest, across)) * interpolated(at, across)
        where = f"solids_flux_{1e3 * height:g}_mm"
        rows += [(where, float(flux.mean()), "m/s"), (f"{where}_size", float(abs(flux).mean()), "m/s")]
    return pd.DataFrame(rows, columns=["quantity", "value", "unit"]).assign(source="measured")


def interpolated(profile_points: pd.DataFrame, x_m: np.ndarray) -> np.ndarray:
    """Values of a measured profile at other positions across the bed [m], the outermost ones beyond it."""
    ordered = profile_points.sort_values("position_x_m")
    return np.interp(x_m, ordered["position_x_m"], ordered["value"])


def half_difference(profile_points: pd.DataFrame, width_m: float) -> np.ndarray:
    """Half the difference of a measured profile and its mirror image, at its points."""
    mirrored = interpolated(profile_points, width_m - profile_points["position_x_m"].to_numpy())
    return np.asarray((profile_points["value"].to_numpy() - mirrored) / 2)


def read_points(file: Path) -> pd.DataFrame:
    """Measured points of a case.

    Parameters
    ----------
    file : Path
        Columns quantity (of `QUANTITIES`), height_m, position_x_m, value; lines with ``#`` are comments.

    Returns
    -------
    DataFrame

    Raises
    ------
    UserError
        The file is missing, lacks a column, names another quantity or holds no number.
    """
    try:
        table = pd.read_csv(file, comment="#")
    except (OSError, ValueError) as error:
        raise UserError(
            f"{file}: no measured points ({error}); only cases with them can be validated"
        ) from error
    if missing := [name for name in POINT_COLUMNS if name not in table]:
        raise UserError(f"{file} lacks the columns {', '.join(missing)}; add them")
    if unknown := sorted(set(map(str, table["quantity"])) - set(QUANTITIES)):
        raise UserError(f"{file}: unknown quantity {', '.join(unknown)}; known: {', '.join(QUANTITIES)}")
    numbers = table[list(POINT_COLUMNS[1:])].apply(pd.to_numeric, errors="coerce")
    if numbers.isna().to_numpy().any() or table.empty:
        row = int(numbers.isna().any(axis=1).argmax()) if len(table) else 0
        raise UserError(f"{file}: row {row + 1} of the points is no number; correct it")
    return table.assign(**{name: numbers[name] for name in numbers})


def rms(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Root of the mean square over the last axis."""
    return np.asarray(np.sqrt((values**2).mean(axis=-1)))


def difference_metrics(
    name: str,
    unit: str,
    simulated: NDArray[np.float64],
    left_out: NDArray[np.float64],
    measured: np.ndarray,
) -> list[dict[str, object]]:
    """Differences of simulated from measured points: rms and mean, with 95 % bands.

    Parameters
    ----------
    name, unit : str
        Of the quantity.
    simulated, measured : (n_points,) ndarray
        In the unit.
    left_out : (BLOCKS, n_points) ndarray
        Simulated points without each block of frames.

    Returns
    -------
    list of dict
        quantity, source, value, unit, ci_low, ci_high.
    """
    rows: list[dict[str, object]] = []
    summaries = (("rms", rms, "positive"), ("mean", lambda values: values.mean(axis=-1), "plain"))
    for summary, over, scale in summaries:
        value = float(over(simulated - measured))
        low, high = block_band(value, over(left_out - measured), scale)
        rows.append(
            {
                "quantity": f"{name}_error_{summary}", "source": "dem", "value": value, "unit": unit,
                "ci_low": float(low), "ci_high": float(high),
            }
        )  # fmt: skip
    return rows


def profile_left_out(
    quantity: str, solids: NDArray[np.float64], boxes: Boxes
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Profile over all frames, and those without each block of frames.

    Parameters
    ----------
    quantity : str
    solids : (n_frames, 2, n_boxes) ndarray
    boxes : Boxes

    Returns
    -------
    (n_boxes,) ndarray, (BLOCKS, n_boxes) ndarray
        In the quantity's unit.
    """
    return profile(quantity, solids.mean(axis=0), boxes), profile(
        quantity, np.asarray(means_left_out(solids)), boxes
    )
