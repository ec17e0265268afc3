# SPDX-License-Identifier: GPL-3.0-or-later
"""What carries the weight of a two-fluid bed: its momentum along the height, from the fields of a frame.

The solver's solids are pushed by ``-p' grad(alpha)``, p' the derivative of their pressure with respect to
their share. That is not the gradient of a pressure, since the granular temperature varies as well (Liu et al.
2024, arXiv:2405.20621, method I): summed over the height it is more or less than the pressure on the floor.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from bedchain.case.schema import Case
from bedchain.dem.two_fluid_fields import Array, read_scalars, read_vectors
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.physics.granular import Granular

OUTSIDE_PA = 1e5  # pressure at the outlet, in the templates
COLUMNS = [
    "time_s",
    "weight_Pa",
    "gas_pressure_Pa",
    "solids_pressure_Pa",
    "floor_pressure_Pa",
    "momentum_Pa_s",
]


class Balance(NamedTuple):
    """Terms of the momentum along the height in a frame, over the area of the floor [Pa; momentum Pa s].

    Attributes
    ----------
    weight : float
        Weight of solids and gas.
    gas_pressure : float
        Pressure drop from the floor to the outlet.
    solids_pressure : float
        Push of the solver's granular pressure on the solids, upwards, without friction.
    floor_pressure : float
        Granular pressure on the floor; what the push would be if it were the gradient of a pressure.
    momentum : float
        Momentum of the solids upwards.
    """

    weight: float
    gas_pressure: float
    solids_pressure: float
    floor_pressure: float
    momentum: float


def read_balance(folder: Path, shape: tuple[int, int], case: Case, largest_solids: float) -> Balance:
    """Terms of a time folder.

    Parameters
    ----------
    folder : Path
        With the fields of the solver.
    shape : (int, int)
        Rows and columns of cells.
    case : dict
    largest_solids : float
        Packing limit [1].
    """
    number = shape[0] * shape[1]
    solids, theta, pressure = (
        read_scalars(folder / name, number).reshape(shape)
        for name in ("alpha.particles", "Theta.particles", "p")
    )
    upwards = read_vectors(folder / "U.particles", number)[:, 2].reshape(shape)
    granular = Granular(case["particles"]["density_kg_m3"], case["contact"]["restitution_1"], largest_solids)
    return balance(solids, theta, pressure, upwards, case, granular)


def balance(
    solids: Array, theta: Array, pressure_Pa: Array, upwards_m_s: Array, case: Case, granular: Granular
) -> Balance:
    """Terms from fields of (rows, columns) cells.

    Parameters
    ----------
    solids, theta, pressure_Pa, upwards_m_s : (rows, columns) array
        Share of the solids [1], granular temperature [m2/s2], gas pressure [Pa], velocity [m/s].
    case : dict
    granular : Granular
    """
    cell_m, density = case["gas"]["cell_size_m"], granular.density_kg_m3
    weight = (solids * density + (1 - solids) * case["gas"]["density_kg_m3"]) * GRAVITY_M_S2 * cell_m
    slope = theta * granular.pressure_slope(solids)
    push = -(slope[1:] + slope[:-1]) / 2 * np.diff(solids, axis=0)
    floor = granular.pressure_over_temperature(solids[0]) * theta[0]
    at_floor, above = pressure_Pa[0].mean(), pressure_Pa[1].mean()
    return Balance(
        float(weight.sum(axis=0).mean()),
        float(at_floor + (at_floor - above) / 2 - OUTSIDE_PA),
        float(push.sum(axis=0).mean()),
        float(floor.mean()),
        float((solids * upwards_m_s).sum(axis=0).mean() * density * cell_m),
    )


def balance_table(times_s: list[float], terms: list[Balance]) -> pd.DataFrame:
    """Terms of frames as a table of `COLUMNS`."""
    return pd.DataFrame(
        [(time_s, *term) for time_s, term in zip(times_s, terms, strict=True)], columns=COLUMNS
    )


def carried(table: pd.DataFrame) -> dict[str, float]:
    """What carries the weight in the mean over frames, each over the weight [1].

    Parameters
    ----------
    table : DataFrame
        As of `balance_table`, of two frames or more.

    Returns
    -------
    dict of str to float
        gas_pressure, solids_pressure (the push), momentum (its loss: what slows down carries weight), rest
        (friction, viscous stress at the floor, gas at the sides), which sum to 1; floor_pressure beside.
    """
    weight = table["weight_Pa"].mean()
    shares = {
        name: float(table[f"{name}_Pa"].mean() / weight)
        for name in ("gas_pressure", "solids_pressure", "floor_pressure")
    }
    ends = table.iloc[[0, -1]]
    gained = np.diff(ends["momentum_Pa_s"])[0] / np.diff(ends["time_s"])[0]
    shares["momentum"] = float(-gained / weight)
    shares["rest"] = 1 - sum(shares[name] for name in ("gas_pressure", "solids_pressure", "momentum"))
    return shares
