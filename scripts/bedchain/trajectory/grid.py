# SPDX-License-Identifier: GPL-3.0-or-later
"""The grid of cells over the bed, numbered from the bottom left, row by row."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bedchain.errors import DataError


@dataclass(frozen=True)
class Grid:
    """Equal rectangular cells over the bed; cell = row * columns + column, row 0 at the bottom.

    Parameters
    ----------
    width_m, height_m : float
        Size of the bed along x and z [m].
    columns, rows : int
        Cells along x and z [1].
    """

    width_m: float
    height_m: float
    columns: int
    rows: int

    def __post_init__(self) -> None:
        if not (self.width_m > 0 and self.height_m > 0):
            raise DataError(f"a bed of {self.width_m} m x {self.height_m} m: both sizes must be positive")
        if self.columns < 1 or self.rows < 1:
            raise DataError(f"a grid of {self.columns} x {self.rows} cells: at least 1 x 1 is needed")
        if self.columns * self.rows > np.iinfo(np.int32).max:
            raise DataError(f"a grid of {self.columns} x {self.rows} cells: cell numbers must fit in int32")

    @property
    def n_cells(self) -> int:
        """Number of cells [1]."""
        return self.columns * self.rows

    @property
    def cell_width_m(self) -> float:
        """Size of a cell along x [m]."""
        return self.width_m / self.columns

    @property
    def cell_height_m(self) -> float:
        """Size of a cell along z [m]."""
        return self.height_m / self.rows

    @property
    def x_edges_m(self) -> NDArray[np.float64]:
        """Edges of the columns, (columns + 1,) [m]."""
        return np.linspace(0.0, self.width_m, self.columns + 1)

    @property
    def z_edges_m(self) -> NDArray[np.float64]:
        """Edges of the rows, (rows + 1,) [m]."""
        return np.linspace(0.0, self.height_m, self.rows + 1)

    @property
    def centres_m(self) -> NDArray[np.float64]:
        """Centres (x, z) of the cells in the order of their numbers, (n_cells, 2) [m]."""
        x = (np.arange(self.columns) + 0.5) * self.cell_width_m
        z = (np.arange(self.rows) + 0.5) * self.cell_height_m
        return np.column_stack((np.tile(x, self.rows), np.repeat(z, self.columns)))

    def cell_of(self, x_m: ArrayLike, z_m: ArrayLike, first_frame: int = 0) -> NDArray[np.int32]:
        """Cell of each position; the far edges of the bed belong to the last column and row.

        Parameters
        ----------
        x_m, z_m : (n_particles,) or (n_frames, n_particles) array
            Positions [m].
        first_frame : int
            Number of the first frame, for the error message.

        Returns
        -------
        int32 array of the same shape
            Cell numbers.

        Raises
        ------
        DataError
            A position is not finite or outside the bed; particle, frame and distance are named.
        """
        x, z = np.asarray(x_m), np.asarray(z_m)
        if x.shape != z.shape:
            raise DataError(f"{x.shape} positions along x but {z.shape} along z")
        self._check_inside(x, z, first_frame)
        # in float64: the quotient in float32 would put particles across edges that they have not reached
        column = np.multiply(x, 1.0 / self.cell_width_m, dtype=np.float64).astype(np.int32)
        row = np.multiply(z, 1.0 / self.cell_height_m, dtype=np.float64).astype(np.int32)
        np.minimum(column, self.columns - 1, out=column)
        np.minimum(row, self.rows - 1, out=row)
        return np.asarray(row * np.int32(self.columns) + column, dtype=np.int32)

    def _check_inside(self, x: NDArray[Any], z: NDArray[Any], first_frame: int) -> None:
        for name, values, top in (("x", x, self.width_m), ("z", z, self.height_m)):
            if values.size == 0:
                continue
            limit = max(top, float(np.asarray(top, dtype=values.dtype)))  # the wall itself, as stored
            if values.min() >= 0 and values.max() <= limit:
                continue
            index = tuple(int(i) for i in np.argwhere(~((values >= 0) & (values <= limit)))[0])
            value = float(values[index])
            excess = -value if value < 0 else value - top
            frame = first_frame + (index[0] if len(index) > 1 else 0)
            raise DataError(
                f"particle {index[-1]} (counted from 0) in frame {frame} is at {name} = {value:g} m, "
                f"{excess:g} m outside the bed (0 to {top:g} m): check the bed's size in the case file, "
                "or whether particles leave the bed"
            )

    def check_resolution(self, resolution_m: float) -> None:
        """Refuse cells finer than the resolution of the data.

        Parameters
        ----------
        resolution_m : float
            Smallest length that the data resolve, at least a particle diameter [m].

        Raises
        ------
        DataError
            A cell is narrower or lower (10^-6 of it is allowed for round-off).
        """
        for name, size, top, count in (
            ("columns", self.cell_width_m, self.width_m, self.columns),
            ("rows", self.cell_height_m, self.height_m, self.rows),
        ):
            if size < resolution_m * (1 - 1e-6):
                raise DataError(
                    f"{count} {name} make cells of {size:g} m, finer than the data resolve "
                    f"({resolution_m:g} m): use at most {int(top / resolution_m * (1 + 1e-6))} {name}"
                )
