# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectrum of a series, and its dominant frequency with its resolution."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import welch

EVEN = 1e-3  # of the mean interval: a series whose intervals differ by more has gaps


class Peak(NamedTuple):
    """Peak of a spectrum.

    Attributes
    ----------
    frequency_hz, resolution_hz : float
        Of the peak, and the distance of two that are told apart [Hz]; NaN where there is none.
    share_1 : float
        Of the variance that is within two such distances of the peak.
    """

    frequency_hz: float
    resolution_hz: float
    share_1: float


class Spectrum(NamedTuple):
    """Share of a series' variance by frequency; empty where a series has none.

    Attributes
    ----------
    frequencies_hz, power : (n,) array
        [Hz], and share of the variance of what is faster than a piece [1].
    """

    frequencies_hz: NDArray[np.float64]
    power: NDArray[np.float64]


def spectrum(times_s: ArrayLike, values: ArrayLike, piece_s: float) -> Spectrum:
    """Spectrum by Welch's method (1967, IEEE Trans. Audio Electroacoust. 15, 70).

    Parameters
    ----------
    times_s, values : (n,) array
        A series at even intervals [s].
    piece_s : float
        Length of the pieces, half overlapping, whose spectra are averaged [s]; the resolution is its inverse.

    Returns
    -------
    Spectrum
        Empty where the series is shorter than a piece, has gaps, or never changes.
    """
    times, seen = np.asarray(times_s, np.float64), np.asarray(values, np.float64)
    nothing = Spectrum(np.empty(0), np.empty(0))
    if len(times) < 2:
        return nothing
    interval_s = (times[-1] - times[0]) / (len(times) - 1)
    length = round(piece_s / interval_s)
    uneven = np.abs(np.diff(times) - interval_s).max() > EVEN * interval_s
    if len(times) < length or length < 4 or uneven or np.ptp(seen) == 0:
        return nothing
    frequencies, power = welch(seen, 1 / interval_s, nperseg=length, detrend="linear")
    power[0] = 0  # what is slower than a piece
    return Spectrum(frequencies, power / power.sum())


def dominant_frequency(times_s: ArrayLike, values: ArrayLike, piece_s: float) -> Peak:
    """Frequency with the most power; arguments as of `spectrum`, NaN where that is empty."""
    frequencies, power = spectrum(times_s, values, piece_s)
    if not len(power):
        return Peak(np.nan, np.nan, np.nan)
    at = int(power.argmax())
    near = power[max(at - 2, 0) : at + 3].sum()
    return Peak(float(frequencies[at]), float(frequencies[1]), float(near))
