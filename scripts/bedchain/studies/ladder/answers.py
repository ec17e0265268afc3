# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers of models about one bed in common terms, and their distance from the simulated bed."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.case.schema import Case
from bedchain.errors import DataError
from bedchain.files import write_text
from bedchain.trajectory.grid import Grid

Array = NDArray[np.float64]
Values = Mapping[str, Array | float]


class Quantity(NamedTuple):
    """A quantity of the ladder: its title, and the unit of its error."""

    title: str
    unit: str


# errors of numbers are relative, of a density the total variation, else root mean squares
QUANTITIES = {
    "particle_height": Quantity("mean particle height", "1"),
    "pressure_drop": Quantity("mean pressure drop", "1"),
    "pressure_frequency": Quantity("pressure frequency", "1"),
    "voidage": Quantity("voidage by height", "1"),
    "density": Quantity("density in cells", "1"),
    "mixing_radial": Quantity("radial mixing", "1"),
    "mixing_axial": Quantity("axial mixing", "1"),
    "stay_low": Quantity("stay in the lower part", "1"),
    "bubble_diameter": Quantity("bubble diameter", "1"),
    "bubble_velocity": Quantity("bubble rise velocity", "1"),
}


@dataclass(frozen=True)
class Answer:
    """What a model says of a bed.

    Attributes
    ----------
    model : str
        Its name.
    values : mapping of str to array or float
        Of `QUANTITIES` as far as the model says them: mean height [m], pressure drop [Pa], voidage of the
        rows of the case's cells [1], share of the particles in each of these cells [1], mixing curves
        (n_times, 2) [1] at multiples of `lag_s` from 0, dominant frequency of the pressure drop [Hz], stay in
        the lower part (`stays`) [s], bubble diameter [m] and rise velocity [m/s].
    cost_s : float
        Processor time for a simulated second [s].
    learning_s, memory_mb : float
        Processor time to learn it [s], and peak memory [MB]; NaN where there is none or it is not known.
    lag_s : float
        Time between points of the mixing curves [s].
    paths : bool
        Whether it can follow a single particle.
    """

    model: str
    values: Values
    cost_s: float
    learning_s: float = np.nan
    memory_mb: float = np.nan
    lag_s: float = np.nan
    paths: bool = False
    note: str = field(default="")


@dataclass(frozen=True)
class Truth:
    """The simulated bed.

    Attributes
    ----------
    values : mapping of str to array or float
        As of `Answer`, all of `QUANTITIES` as far as they were seen; mixing curves at each frame.
    floors : mapping of str to float
        What realisations, or parts of the run, differ by from their mean [1].
    interval_s : float
        Between frames [s].
    """

    values: Values
    floors: Mapping[str, float]
    interval_s: float


def distance(quantity: str, said: Array | float, true: Array | float) -> float:
    """Error of a value [1]: relative of a number, total variation of a density, else root mean square."""
    if np.ndim(true) == 0:
        return float(abs(np.asarray(said) / np.asarray(true) - 1))
    difference = np.asarray(said) - np.asarray(true)
    if quantity == "density":
        return float(np.abs(difference).sum() / 2)
    if quantity.startswith("mixing"):
        difference = difference[1:]  # all curves start at 1
    return float(np.sqrt(np.mean(difference**2)))


def error_of(quantity: str, answer: Answer, truth: Truth) -> float:
    """Error of an answer [1]; of mixing curves at the times that both have."""
    said, true = answer.values[quantity], truth.values[quantity]
    if not quantity.startswith("mixing"):
        return distance(quantity, said, true)
    every = max(round(answer.lag_s / truth.interval_s), 1)
    seen = np.asarray(true)[::every]
    both = min(len(seen), len(np.asarray(said)))
    return distance(quantity, np.asarray(said)[:both], seen[:both])


def ladder_rows(answers: list[Answer], truth: Truth) -> pd.DataFrame:
    """Rows of ladder.csv.

    Returns
    -------
    DataFrame
        model, quantity, value, truth (numbers only), unit, error_1, noise_floor_1, error_floors,
        cost_s_per_s, learning_s, memory_mb, note. A model has no row for what it cannot say.
    """
    rows = []
    for answer in answers:
        costs = {
            "cost_s_per_s": answer.cost_s,
            "learning_s": answer.learning_s,
            "memory_mb": answer.memory_mb,
        }
        for name in QUANTITIES:
            if name not in answer.values or name not in truth.values:
                continue
            if np.ndim(answer.values[name]) == 0 and not np.isfinite(answer.values[name]):
                continue
            said, true, floor = answer.values[name], truth.values[name], truth.floors.get(name, np.nan)
            number = np.ndim(true) == 0
            error = error_of(name, answer, truth)
            rows.append(
                {
                    "model": answer.model, "quantity": name,
                    "value": float(np.asarray(said)) if number else np.nan,
                    "truth": float(np.asarray(true)) if number else np.nan,
                    "unit": UNITS.get(name, "1"), "error_1": error, "noise_floor_1": floor,
                    "error_floors": error / floor, **costs, "note": answer.note,
                }
            )  # fmt: skip
        if answer.paths:
            paths = {"model": answer.model, "quantity": "single_paths", "value": 1.0, "unit": "1"}
            rows.append({**paths, **costs, "note": answer.note})
    return pd.DataFrame(rows)


UNITS = {
    **{"particle_height": "m", "pressure_drop": "Pa", "pressure_frequency": "Hz", "stay_low": "s"},
    **{"bubble_diameter": "m", "bubble_velocity": "m/s"},
}


def read_answer(file: Path) -> Answer:
    """A model that ran elsewhere, such as a cheaper bed: JSON with the names of `Answer`, lists for arrays.

    Raises
    ------
    DataError
        It names no model or cost, or a quantity that the ladder does not know, or a value that is no number.
    """
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise DataError(f"{file} is no JSON: {error}") from None
    names = {item.name for item in fields(Answer)}
    if not isinstance(content, dict) or not isinstance(content.get("values", {}), dict):
        raise DataError(f"{file} holds no model: take the names of Answer, and values by quantity")
    if missing := {"model", "cost_s", "values"} - content.keys():
        raise DataError(f"{file} lacks {', '.join(sorted(missing))}")
    if unknown := [*(content.keys() - names), *(content["values"].keys() - QUANTITIES.keys())]:
        raise DataError(
            f"{file}: {', '.join(sorted(unknown))} is known to no ladder: {', '.join(QUANTITIES)}"
        )
    try:
        arrays = {name: np.asarray(value, np.float64) for name, value in content["values"].items()}
    except (TypeError, ValueError) as error:
        raise DataError(f"{file}: a value is no number or no even list of numbers ({error})") from None
    values = {name: value if value.ndim else float(value) for name, value in arrays.items()}
    return Answer(**content | {"values": values})


def write_answer(answer: Answer, file: Path) -> None:
    """Write what `read_answer` reads."""
    values = {name: np.asarray(value).tolist() for name, value in answer.values.items()}
    content = {name: value for name, value in asdict(answer).items() if value == value} | {"values": values}
    write_text(file, json.dumps(content) + "\n")


def of_density(share: Array, grid: Grid, case: Case) -> dict[str, Array | float]:
    """What follows from the share of the particles in each cell of the case: height, voidage, density."""
    bed, particles = case["bed"], case["particles"]
    rows = share.reshape(grid.rows, grid.columns).sum(axis=1)
    middles = (grid.z_edges_m[1:] + grid.z_edges_m[:-1]) / 2
    solids = particles["number"] * np.pi / 6 * particles["diameter_m"] ** 3
    held = rows * solids / (bed["width_m"] * bed["thickness_m"] * np.diff(grid.z_edges_m))
    return {"density": share, "voidage": 1 - held, "particle_height": float(rows @ middles)}
