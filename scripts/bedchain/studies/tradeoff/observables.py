# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of the trade-off (curves, densities, scalars), of the reference and other beds, and errors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bedchain.studies.scan import REPLICATES
from bedchain.uncertainty.deviations import (
    SIDES,
    band,
    distances,
    interval,
    mean_of_others,
    resampled,
    rms,
    stacked,
)
from bedchain.uncertainty.noise_floor import LEVEL, ROUND_OFF, floor_of

Array = NDArray[np.float64]
Row = dict[str, Any]

CURVES = ("left", "right", "low", "up", "mixing")
DENSITY = "density"
# observables of the bed as a whole, with their units
SCALARS = {
    "mixing_time_radial": "s",
    "mixing_time_axial": "s",
    "bed_height": "m",
    "pressure_drop": "Pa",
    "pressure_drop_spread": "Pa",
    "dispersion_x": "m2_s",
    "dispersion_z": "m2_s",
    "granular_temperature": "m2_s2",
}
UNITS = dict.fromkeys((*CURVES, DENSITY), "1") | SCALARS
# of the intervals only: the same data give the same interval
INTERVAL_SEED = 23


@dataclass(frozen=True)
class BedObservables:
    """Observables of one simulated bed over the comparison window.

    Attributes
    ----------
    curves : (n_frames, 4) array
        Mixing curves from the first frame after the start [1].
    densities : (2, n_cells) array
        Mean shares in the cells over either half of the window [1].
    scalars : dict of str to float
        By the names of `SCALARS`.
    """

    curves: Array
    densities: Array
    scalars: dict[str, float]


@dataclass(frozen=True)
class Reference:
    """Observables of the bed that all is compared with, in all its realisations.

    Parameters
    ----------
    curves : (n_curves, n_frames, 4) array
        Mixing curves from the first frame after the start: of the run and its repeats, or, without repeats,
        of several starts of the run, NaN where one has ended [1].
    repeated : bool
        Whether the curves are of repeats, whose spread is the noise floor.
    densities : (n_runs, 2, n_cells) array
        Mean shares in the cells over either half of the comparison window, of each run whose positions are
        there [1].
    scalars : dict of str to tuple of float
        Values of each of `SCALARS`, the run's first.
    """

    curves: Array
    repeated: bool
    densities: Array
    scalars: dict[str, tuple[float, ...]]

    def floors(self) -> dict[str, float]:
        """Noise floor of every observable, NaN where there are no repeats; that of a density also without.

        Of curves: difference between one realisation and the mean of all. Of densities: between one and the
        mean of the others, or between the halves of the window. Of scalars: the standard deviation.
        """
        floors = dict.fromkeys(UNITS, np.nan)
        if self.repeated:
            floors |= {name: floor_of(self.curves[..., list(SIDES[name])]) for name in CURVES}
        floors[DENSITY] = float(np.nanmean(self._between_densities()))
        for name, values in self.scalars.items():
            known = np.array(values)[np.isfinite(values)]
            floors[name] = float(known.std(ddof=1)) if known.size > 1 else np.nan
        return floors

    def joined(self, others: Sequence[BedObservables]) -> Self:
        """The reference with further realisations of its bed; curves join those of repeats only."""
        if not others:
            return self
        curves = [*self.curves, *(bed.curves for bed in others)] if self.repeated else self.curves
        scalars = {
            name: (*values, *(bed.scalars[name] for bed in others if name in bed.scalars))
            for name, values in self.scalars.items()
        }
        densities = np.stack([*self.densities, *(bed.densities for bed in others)])
        return replace(self, curves=stacked(list(curves)), densities=densities, scalars=scalars)

    def _between_densities(self) -> Array:
        runs, halves, n_cells = self.densities.shape
        table = self.densities.reshape(runs * halves, 1, n_cells)
        group = np.tile(np.arange(halves), runs) if runs > 1 else np.zeros(halves, np.int64)
        return distances(table, mean_of_others(table, group))


def bed_errors(reference: Reference, bed: BedObservables) -> Row:
    """Errors of all observables of a simulated bed, as columns."""
    return (
        curve_errors(reference, bed.curves[None, None])
        | density_errors(reference, bed.densities[None])
        | scalar_errors(reference, bed.scalars)
    )


def curve_errors(reference: Reference, curves: Array) -> Row:
    """Root-mean-square differences from the reference's curves, with 95 % intervals.

    The exact mean of all realisations has an error of 1 noise floor, a further realisation of sqrt(2).

    Parameters
    ----------
    reference : Reference
    curves : (n_draws, n_curves or 1, n_frames, 4) array
        Of a chain or another bed, at the reference's frames [1]; several draws of a Monte Carlo.

    Returns
    -------
    dict
        As `columns`, of `CURVES`; intervals over realisations (or starts) and draws, NaN for a single one.
    """
    shape = (len(curves), *reference.curves.shape)
    error = np.broadcast_to(curves, shape) - reference.curves[None]
    error = error.reshape(-1, *shape[2:])
    curve = np.tile(np.arange(shape[1]), shape[0])
    run = curve if reference.repeated else np.zeros(len(curve), np.int64)
    weights = resampled(run, REPLICATES, np.random.default_rng(INTERVAL_SEED))
    floors = reference.floors()
    row: Row = {}
    for name in CURVES:
        part = error[..., list(SIDES[name])]
        ends = interval(rms, part, weights)
        row |= columns(name, float(rms(part)), ends, floors[name])
    return row


def density_errors(reference: Reference, densities: Array) -> Row:
    """Total variation from the reference's mean densities over halves of the comparison window.

    Parameters
    ----------
    reference : Reference
    densities : (n_draws, 2, n_cells) array
        Mean shares over either half, on the cells of the reference [1].

    Returns
    -------
    dict
        As `columns`, of `DENSITY`; the interval is over realisations, halves and draws.
    """
    runs, halves, n_cells = reference.densities.shape
    shape = (len(densities), runs, halves, n_cells)
    pair = (np.broadcast_to(part, shape) for part in (densities[:, None], reference.densities[None]))
    errors = distances(*(part.reshape(-1, 1, n_cells) for part in pair)).ravel()
    rng = np.random.default_rng(INTERVAL_SEED)
    means = rng.choice(errors, (REPLICATES, errors.size)).mean(axis=1)
    low, high = band(means)
    return columns(DENSITY, float(errors.mean()), (float(low), float(high)), reference.floors()[DENSITY])


def scalar_errors(reference: Reference, scalars: dict[str, float]) -> Row:
    """Signed differences from the mean of the realisations.

    Parameters
    ----------
    reference : Reference
    scalars : dict of str to float
        Of another bed, by the names of `SCALARS`.

    Returns
    -------
    dict
        As `columns`; the interval is that of the difference between a single further realisation and the mean
        of n (Student's t, n - 1 degrees of freedom), NaN without repeats.
    """
    floors = reference.floors()
    row: Row = {}
    for name in SCALARS:
        known = np.array(reference.scalars.get(name, ()), float)
        known = known[np.isfinite(known)]
        if not known.size or name not in scalars:
            continue
        error, half = scalars[name] - float(known.mean()), np.nan
        if known.size > 1:
            quantile = float(special.stdtrit(known.size - 1, (1 + LEVEL) / 2))
            half = quantile * floors[name] * np.sqrt(1 + 1 / known.size)
        row |= columns(name, error, (error - half, error + half), floors[name])
    return row


def columns(name: str, error: float, ends: tuple[float, float], floor: float) -> Row:
    """The columns of one observable: error and its 95 % interval in its unit, and error in noise floors."""
    unit = UNITS[name]
    return {
        f"{name}_error_{unit}": error,
        f"{name}_ci_low_{unit}": ends[0],
        f"{name}_ci_high_{unit}": ends[1],
        f"{name}_floors_1": error / floor if floor > ROUND_OFF else np.nan,
    }


def all_columns() -> list[str]:
    """Columns of all observables, in their order."""
    return [column for name in UNITS for column in columns(name, np.nan, (np.nan, np.nan), np.nan)]
