# SPDX-License-Identifier: GPL-3.0-or-later
"""Static mixer that is turned over: particles fall through its cells, then top becomes bottom, and again.

Ponomarev, Mizonov, Berthiaux, Gatumel, Gyenis, Barantseva, Chem. Eng. Process. 48 (2009) 1495-1505. A
revolution is so many steps of falling, then a turn. The turn takes no time: it is part of the last step's
matrix.
"""

from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.networks.network import Network, State
from bedchain.errors import DataError

Array = NDArray[np.float64]
# a cell that holds more than its capacity by more than this is overfull [1]
OVERFULL = 1e-9
# rows up to which all loadings can be tried: 12 870 of 16
MOST_ROWS_TRIED = 16


def reflected_walk(cells: int, forward: float, back: float) -> Array:
    """Matrix of a walk between two walls that reflect, (cells, cells).

    Raises
    ------
    DataError
        Both probabilities sum to more than 1.
    """
    if forward + back > 1:
        raise DataError(
            f"moves of {forward:g} and {back:g} leave the cells with more than 1: take smaller ones"
        )
    ahead, behind = np.full(cells - 1, forward), np.full(cells - 1, back)
    matrix = np.diag(ahead, 1) + np.diag(behind, -1)
    return matrix + np.diag(1 - matrix.sum(axis=1))


def static_mixer(
    rows: int, columns: int, steps: int, down_1: float, up_1: float, sideways_1: float, step_s: float = 1.0
) -> Network:
    """Chain of one component in the mixer.

    Parameters
    ----------
    rows, columns : int
        Cells; row 0 is at the top.
    steps : int
        Steps of falling in a revolution.
    down_1, up_1, sideways_1 : float
        Probabilities to move in a step, sideways to each side [1]; walls reflect.
    step_s : float
        Time of a step [s].

    Returns
    -------
    Network
        Closed, each cell with the capacity 1, cell (column, row) at number ``row * columns + column``.
    """
    across = reflected_walk(columns, sideways_1, sideways_1)
    falling = sparse.csr_array(np.kron(reflected_walk(rows, down_1, up_1), across))
    turn = sparse.csr_array(np.kron(np.eye(rows)[::-1], np.eye(columns)))
    states = [
        State(f"column {column + 1} row {row + 1}", 1.0, rows - 0.5 - row, f"column {column + 1}")
        for row in range(rows)
        for column in range(columns)
    ]
    turned = sparse.csr_array(falling @ turn)
    return Network(tuple(states), (*[falling] * (steps - 1), turned), step_s=step_s)


def loaded(rows: int, columns: int, where: str, amount: float) -> Array:
    """Contents at the start, (rows * columns,).

    Parameters
    ----------
    rows, columns : int
    where : {"top", "bottom", "left", "right", "bands", "between_bands"}
        Bands is 0110 repeated from the top, the best of a walk with equal moves (Uchimura et al. 1983, J.
        Oper. Res. Soc. Japan 26, 2); between_bands the rest.
    amount : float
        In each loaded cell, of its capacity of 1 [1].

    Raises
    ------
    DataError
        The mixer cannot be divided so.
    """
    down, across = np.divmod(np.arange(rows * columns), columns)
    bands = np.isin(down % 4, (1, 2))
    half = {
        "top": (down < rows // 2, rows % 2),
        "bottom": (down >= rows // 2, rows % 2),
        "left": (across < columns // 2, columns % 2),
        "right": (across >= columns // 2, columns % 2),
        "bands": (bands, rows % 4),
        "between_bands": (~bands, rows % 4),
    }
    cells, rest = half[where]
    if rest:
        wanted = "a multiple of 4 rows" if "bands" in where else "an even number of rows and columns"
        raise DataError(
            f"a mixer of {rows} rows and {columns} columns is not loaded by {where}: it needs {wanted}"
        )
    return np.where(cells, amount, 0.0)


def check_filling(contents: Array, names: list[str]) -> None:
    """Refuse cells that hold more than their capacity: a linear chain does not push the surplus on.

    Parameters
    ----------
    contents : (n_steps, n_cells) array
        Of all components together, of a capacity of 1 [1].
    names : list of str
        Of the cells.

    Raises
    ------
    DataError
        A cell is overfull; the message names it, the step and how full the mixer may be at the start.
    """
    if (fullest := float(contents.max())) > 1 + OVERFULL:
        step, cell = np.unravel_index(int(np.argmax(contents)), contents.shape)
        raise DataError(
            f"{names[cell]} holds {fullest:.4g} of its capacity of 1 at step {step}, since what "
            "segregates gathers there: "
            f"load at most {contents[0].max() / fullest:.3f} of the cells' capacity"
        )


def loading_variances(rows: int, steps: int, move_1: float) -> dict[str, float]:
    """Variance after some steps of every loading of half the rows of a column, smallest first.

    Parameters
    ----------
    rows : int
        At most `MOST_ROWS_TRIED`, even.
    steps : int
        Of falling, without a turn.
    move_1 : float
        Probability to move down, and up [1].

    Returns
    -------
    dict of str to float
        Variance over that of the start, by the loading from the top, such as 0110.

    Raises
    ------
    DataError
        There are too many rows, or an odd number.
    """
    if rows > MOST_ROWS_TRIED or rows % 2:
        raise DataError(
            f"all loadings of {rows} rows are not tried: take an even number up to {MOST_ROWS_TRIED}"
        )
    after = np.linalg.matrix_power(reflected_walk(rows, move_1, move_1), steps)
    variances = {}
    for places in combinations(range(rows), rows // 2):
        start = np.zeros(rows)
        start[list(places)] = 1.0
        variances["".join(f"{cell:.0f}" for cell in start)] = float((start @ after).var() / start.var())
    return dict(sorted(variances.items(), key=lambda pair: (round(pair[1], 12), pair[0])))
