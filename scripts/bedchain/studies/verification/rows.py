# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of the verification table: a value, its reference, the tolerance and the value's own error."""

import math
from dataclasses import dataclass

import pandas as pd


@dataclass(frozen=True)
class Row:
    """A checked quantity.

    Attributes
    ----------
    quantity : str
        Name, with its unit in brackets.
    value : float
        Of the solver.
    reference : float
        Of the theory.
    tolerance : float
        Largest difference allowed: relative to the reference, absolute where the reference is 0.
    source : str
        Paper, equation or law behind the reference.
    error : float
        Standard error of a value that is an average over time, particles or places, or a fit to a series
        (`uncertainty.bands.block_error`), in the value's unit. NaN where nothing is averaged: one particle,
        a lattice in a steady gas, a count or an extreme.
    """

    quantity: str
    value: float
    reference: float
    tolerance: float
    source: str
    error: float = math.nan

    @property
    def passed(self) -> bool:
        """Whether the value is within the tolerance; never for a NaN."""
        scale = abs(self.reference) if self.reference else 1.0
        return math.isfinite(self.value) and abs(self.value - self.reference) <= self.tolerance * scale


def table_of(rows: list[Row]) -> pd.DataFrame:
    """Columns: quantity, value, reference, error (NaN where nothing is averaged), tolerance, pass, source."""
    return pd.DataFrame(
        {
            "quantity": [row.quantity for row in rows],
            "value": [row.value for row in rows],
            "reference": [row.reference for row in rows],
            "error": [row.error for row in rows],
            "tolerance": [row.tolerance for row in rows],
            "pass": ["yes" if row.passed else "no" for row in rows],
            "source": [row.source for row in rows],
        }
    )
