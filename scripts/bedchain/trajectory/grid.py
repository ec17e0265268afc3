# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells of a bed in one, two or three dimensions, numbered from the bottom left, row by row."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bedchain.errors import DataError
from bedchain.trajectory.coordinates import Coordinates, Size, check_inside, coordinates_of, limit_of

# cell of a particle that is not in the frame, or is outside a bed that it may leave
OUTSIDE = -1


@dataclass(frozen=True)
class Grid:
    """Cells over the bed; cell = (layer * rows + row) * columns + column, row 0 at the bottom.

    Boxes by default, of which columns lie along x, rows along z and layers along y. Rings and sectors are
    equal steps of the distance from an axis and of the angle (`bedchain.trajectory.coordinates`); columns,
    rows and layers are then along those, and so are widths, heights and edges of cells.

    Parameters
    ----------
    width_m, height_m : float
        Size of the bed along x and z [m].
    columns, rows : int
        Cells along the first and the second coordinate, x and z of boxes [1].
    depth_m : float
        Size of the bed along y [m]; 0 where no cell needs it.
    layers : int
        Cells along the third coordinate, y of boxes [1].
    form : {"boxes", "rings", "sectors"}
    axis : {"vertical", "horizontal"}
        Of the cylinder that rings and sectors divide.
    """

    width_m: float
    height_m: float
    columns: int
    rows: int
    depth_m: float = 0.0
    layers: int = 1
    form: str = field(default="boxes", kw_only=True)
    axis: str = field(default="vertical", kw_only=True)

    def __post_init__(self) -> None:
        shape = " x ".join(str(n) for n in self.counts[: 3 if self.is_deep else 2])
        if not (self.width_m > 0 and self.height_m > 0):
            raise DataError(f"a bed of {self.width_m} m x {self.height_m} m: both sizes must be positive")
        if min(self.counts) < 1:
            raise DataError(f"a grid of {shape} cells: at least 1 x 1 is needed")
        if self.n_cells > np.iinfo(np.int32).max:
            raise DataError(f"a grid of {shape} cells: cell numbers must fit in int32")
        if self.is_deep and not self.depth_m > 0:
            raise DataError(
                f"a grid of {shape} cells in a bed {self.depth_m} m deep: the depth must be positive"
            )
        if self.layers > 1 and not self.coordinates.names[2]:
            raise DataError(f"a grid of {shape} {self.form}: they have no layers")

    @property
    def counts(self) -> tuple[int, int, int]:
        """Columns, rows and layers [1]."""
        return self.columns, self.rows, self.layers

    @property
    def is_deep(self) -> bool:
        """Whether the depth of the bed counts."""
        return self.layers > 1 or any(self._uses_y)

    @property
    def needs_y(self) -> bool:
        """Whether a particle's cell depends on y."""
        return any(self._uses_y)

    @cached_property
    def _uses_y(self) -> list[bool]:
        return [used and n > 1 for used, n in zip(self.coordinates.uses_y, self.counts, strict=True)]

    @cached_property
    def coordinates(self) -> Coordinates:
        """Coordinates of its columns, rows and layers."""
        return coordinates_of(self.form, self.axis, self.size)

    @property
    def size(self) -> Size:
        """Size of the bed."""
        return Size(self.width_m, self.height_m, self.depth_m)

    @cached_property
    def lengths_m(self) -> tuple[float, float, float]:
        """Lengths that the columns, the rows and the layers divide [m]."""
        return self.coordinates.lengths(self.size)

    @property
    def n_cells(self) -> int:
        """Number of cells [1]."""
        return self.columns * self.rows * self.layers

    @property
    def cell_width_m(self) -> float:
        """Length of a cell along the columns' coordinate, x of boxes [m]."""
        return self.lengths_m[0] / self.columns

    @property
    def cell_height_m(self) -> float:
        """Length of a cell along the rows' coordinate, z of boxes [m]."""
        return self.lengths_m[1] / self.rows

    @property
    def x_edges_m(self) -> NDArray[np.float64]:
        """Edges of the columns, (columns + 1,) [m]."""
        return np.linspace(0.0, self.lengths_m[0], self.columns + 1)

    @property
    def z_edges_m(self) -> NDArray[np.float64]:
        """Edges of the rows, (rows + 1,) [m]."""
        return np.linspace(0.0, self.lengths_m[1], self.rows + 1)

    @property
    def heights_m(self) -> NDArray[np.float64]:
        """Heights that cut the bed into as many layers as there are rows, (rows + 1,) [m]."""
        return np.linspace(0.0, self.height_m, self.rows + 1)

    @property
    def centres_m(self) -> NDArray[np.float64]:
        """Places (x, z) of the middles of the cells in the order of their numbers, (n_cells, 2) [m]."""
        column, row, layer = self.indices(np.arange(self.n_cells))
        first, second, third = self.lengths_m
        middles = ((column + 0.5) * (first / self.columns), (row + 0.5) * (second / self.rows),
                   (layer + 0.5) * (third / self.layers))  # fmt: skip
        return np.column_stack(self.coordinates.place(*middles, self.size)[:2])

    @property
    def rows_are_heights(self) -> bool:
        """Whether rows lie along z."""
        return self.coordinates.names[1] == "z"

    @property
    def shown(self) -> "Grid":
        """Flat grid of its columns and rows, for pictures: `projected` gives the values of its cells."""
        return Grid(self.lengths_m[0], self.lengths_m[1], self.columns, self.rows)

    def picture(
        self, x: NDArray[Any], z: NDArray[Any], y_m: NDArray[Any] | None = None
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Places of particles in a picture of `shown`; arguments as `cell_of` [m]."""
        values = self._coordinates(x, z, y_m)
        return values[0], values[1]

    @property
    def labels(self) -> tuple[str, str]:
        """Labels of the axes of a picture; the first says what the picture is, where it is a projection."""
        across, up = (f"{name} [m]" for name in self.coordinates.names[:2])
        return f"{across} ({self.projection})" if self.projection else across, up

    @property
    def projection(self) -> str:
        """How a picture shows the cells, for its caption; empty where columns and rows are all there is."""
        if self.form == "boxes" and self.layers == 1:
            return ""
        first, second, third = self.coordinates.names
        unrolled = f"{self.form}, {self.axis} axis" if self.form != "boxes" else ""
        added = f"added up over {third}" if self.layers > 1 else ""
        return ", ".join(filter(None, (unrolled, added)))

    def indices(self, cells: NDArray[np.integer]) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Column, row and layer of cells."""
        layer, plane = np.divmod(cells, self.columns * self.rows)
        row, column = np.divmod(plane, self.columns)
        return column, row, layer

    def projected(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of the cells added up over the layers, (..., n_cells) to those of `shown`."""
        if self.layers == 1:
            return np.asarray(values)
        return np.reshape(values, (*np.shape(values)[:-1], self.layers, self.rows * self.columns)).sum(
            axis=-2
        )

    def arrays(self) -> dict[str, Any]:
        """Numbers that `from_arrays` makes the grid of; a flat box needs the first four alone."""
        flat = {name: getattr(self, name) for name in ("columns", "rows", "width_m", "height_m")}
        if self.form == "boxes" and self.layers == 1:
            return flat
        return flat | {name: getattr(self, name) for name in ("depth_m", "layers", "form", "axis")}

    @classmethod
    def from_arrays(cls, arrays: Any) -> "Grid":
        """Grid from a mapping that holds the numbers of `arrays`."""
        types = {"width_m": float, "height_m": float, "columns": int, "rows": int}
        types |= {"depth_m": float, "layers": int, "form": str, "axis": str}
        values: dict[str, Any] = {name: kind(arrays[name]) for name, kind in types.items() if name in arrays}
        return cls(**values)

    def cell_of(
        self, x_m: ArrayLike, z_m: ArrayLike, first_frame: int = 0, y_m: ArrayLike | None = None
    ) -> NDArray[np.int32]:
        """Cell of each position; the far edges of the bed belong to the last column, row and layer.

        Parameters
        ----------
        x_m, z_m : (n_particles,) or (n_frames, n_particles) array
            Positions [m].
        first_frame : int
            Number of the first frame, for the error message.
        y_m : array of the same shape, optional
            Positions along the depth [m], which some forms of cells need.

        Returns
        -------
        int32 array of the same shape
            Cell numbers.

        Raises
        ------
        DataError
            A position is not finite or outside the bed; particle, frame and distance are named. Or y is
            needed and not given.
        """
        x, z = np.asarray(x_m), np.asarray(z_m)
        if x.shape != z.shape:
            raise DataError(f"{x.shape} positions along x but {z.shape} along z")
        values = self._coordinates(x, z, y_m)
        check_inside(self.coordinates.names, values, self.lengths_m, self.form, first_frame)
        cells = np.zeros(x.shape, np.int32)
        for value, length, count in list(zip(values, self.lengths_m, self.counts, strict=False))[::-1]:
            if count > 1:
                # float64: in float32 the quotient would put particles across edges not reached yet
                index = np.multiply(value, 1.0 / (length / count), dtype=np.float64).astype(np.int32)
                cells *= np.int32(count)
                cells += np.minimum(index, count - 1)
        return cells

    def cells_seen(
        self, x_m: ArrayLike, z_m: ArrayLike, first_frame: int = 0, y_m: ArrayLike | None = None,
        may_leave: bool = False,
    ) -> NDArray[np.int32]:  # fmt: skip
        """`cell_of` where particles come and go: `OUTSIDE` for those that are not in a frame (x is NaN).

        Parameters
        ----------
        x_m, z_m, first_frame, y_m
            As `cell_of`.
        may_leave : bool
            A particle outside the bed is `OUTSIDE` too, instead of an error.
        """
        x, z = np.asarray(x_m), np.asarray(z_m)
        y = None if y_m is None else np.asarray(y_m)
        seen = np.isfinite(x)
        if may_leave:
            values = self._coordinates(x, z, y)
            for value, length in zip(values, self.lengths_m, strict=False):
                seen &= (value >= 0) & (value <= limit_of(self.form, length, value))
        if seen.all():
            return self.cell_of(x, z, first_frame, y)
        inside = [
            None if part is None else np.where(seen, part, length / 2)
            for part, length in zip((x, z, y), self.size, strict=True)
        ]
        assert inside[0] is not None and inside[1] is not None
        return np.where(seen, self.cell_of(inside[0], inside[1], first_frame, inside[2]), np.int32(OUTSIDE))

    def _coordinates(self, x: NDArray[Any], z: NDArray[Any], y_m: ArrayLike | None) -> list[NDArray[Any]]:
        """Coordinates of positions, those that cells depend on or walls bound [m]."""
        if self.needs_y and y_m is None:
            raise DataError(
                f"{self.form} of {self.columns} x {self.rows} x {self.layers} cells need the third axis, y: "
                "the frames have none; keep it when they are read, or take cells of x and z alone"
            )
        if self.form == "boxes" and self.layers == 1:
            return [x, z]
        y = np.full(np.shape(x), self.depth_m / 2) if y_m is None else np.asarray(y_m)
        values = list(self.coordinates.of(x, z, y, self.size))
        return values[: 3 if self.is_deep else 2]

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
        names = ("columns", "rows", "layers")[: 3 if self.layers > 1 else 2]
        for name, top, count in zip(names, self.lengths_m, self.counts, strict=False):
            if top / count < resolution_m * (1 - 1e-6):
                raise DataError(
                    f"{count} {name} make cells of {top / count:g} m, finer than the data resolve "
                    f"({resolution_m:g} m): use at most {int(top / resolution_m * (1 + 1e-6))} {name}"
                )
