# SPDX-License-Identifier: GPL-3.0-or-later
"""Series with a known memory."""

import numpy as np
from scipy import signal


def correlated_series(n: int, rho: float, rng: np.random.Generator) -> np.ndarray:
    """Gaussian series of variance 1 whose neighbours correlate by rho (AR(1))."""
    noise = rng.normal(0, np.sqrt(1 - rho**2), n)
    noise[0] = rng.normal()
    return signal.lfilter([1], [1, -rho], noise)
