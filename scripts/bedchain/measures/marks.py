# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked particles: by a plane, a ring, type, size, or a file of ids; and how separate they are."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.measures.mixing import lacey_index
from bedchain.trajectory.coordinates import Size
from bedchain.trajectory.particles import Particles

Places = NDArray[Any]
MEASURES = ("lacey_index", "coefficient_of_variation", "height_separation")


@dataclass(frozen=True)
class Mark:
    """A rule that marks particles; exactly one of the fields beside the name is given.

    Attributes
    ----------
    name : str
    plane : dict, optional
        ``normal`` (x, y, z) and ``offset_m``: places whose product with the normal is below the offset [m].
    ring : dict, optional
        ``radius_m`` and ``axis`` (vertical or horizontal): places nearer to the middle axis of the bed [m].
    types : list of int, optional
        Types of particles.
    diameter_below_m : float, optional
        Particles smaller than this [m].
    ids : str, optional
        File of ids, one in a line.
    """

    name: str
    plane: dict[str, Any] | None = None
    ring: dict[str, Any] | None = None
    types: list[int] | None = None
    diameter_below_m: float | None = None
    ids: str | None = None

    @property
    def lasts(self) -> bool:
        """Whether it marks the particles themselves, not the place where they start."""
        return self.plane is None and self.ring is None

    def region(self, size: Size) -> Callable[[Places, Places, Places], Places]:
        """The part of the bed that marks, as a function of x, z, y [m] that gives bools.

        Parameters
        ----------
        size : Size
            Of the bed.
        """
        if self.plane is not None:
            across, deep, up = (float(part) for part in self.plane["normal"])
            offset_m = float(self.plane["offset_m"])
            return lambda x, z, y: across * x + deep * y + up * z < offset_m
        assert self.ring is not None
        radius_m, vertical = float(self.ring["radius_m"]), self.ring.get("axis", "vertical") == "vertical"
        other = size.depth_m if vertical else size.height_m

        def near(x: Places, z: Places, y: Places) -> Places:
            return np.hypot(x - size.width_m / 2, (y if vertical else z) - other / 2) < radius_m

        return near

    def of_particles(self, particles: Particles | None, folder: Path = Path()) -> NDArray[np.bool_]:
        """Particles that it marks, by type, size or id, (n_particles,).

        Parameters
        ----------
        particles : Particles or None
            Properties, where there are some.
        folder : Path
            That the file of ids is relative to.

        Raises
        ------
        UserError
            The property is not known, the file is not readable, or an id is not in the bed.
        """
        if self.types is not None and particles is not None and particles.type is not None:
            return np.isin(particles.type, self.types)
        if self.diameter_below_m is not None and particles is not None and particles.radius_m is not None:
            return np.asarray(2 * particles.radius_m < self.diameter_below_m)
        if self.ids is None or particles is None:
            wanted = "types" if self.types is not None else "ids" if self.ids is not None else "radii"
            raise UserError(
                f"marks: {self.name} needs {wanted} of the particles, which the frames lack: keep that "
                "column when they are written, or mark by a plane"
            )
        ids = read_ids(folder / self.ids)
        if (strange := np.setdiff1d(ids, particles.ids)).size:
            raise UserError(
                f"marks: {self.name}: id {strange[0]} of {self.ids} is no particle of the bed, nor are "
                f"{strange.size - 1} others: take ids of its frames"
            )
        return np.isin(particles.ids, ids)


def read_ids(file: Path) -> NDArray[np.int64]:
    """Ids of particles in a file, one in a line.

    Raises
    ------
    UserError
        There is no such file, it is empty, or a line is no whole number.
    """
    try:
        lines = file.read_text(encoding="utf-8").split()
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(
            f"{file}: no readable file of ids ({error}); give one with an id in each line"
        ) from error
    for number, line in enumerate(lines, 1):
        if not line.isdecimal() or len(line) > 18:
            raise UserError(f"{file}, line {number}: {line[:40]!r} is no id: give one in each line")
    if not lines:
        raise UserError(f"{file} holds no ids: give one in each line")
    return np.array(lines, np.int64)


def separation(
    marked: NDArray[Any], total: NDArray[Any], heights_m: NDArray[Any]
) -> tuple[float, float, float]:
    """How separate marked particles are from the others, by `MEASURES`.

    Parameters
    ----------
    marked, total : (n_cells,) array
        Marked and all particles in each cell [1].
    heights_m : (n_cells,) array
        Height of each cell's middle [m].

    Returns
    -------
    lacey_index : float
        0 separated, 1 the expected index of a random mixture (`mixing.lacey_index`).
    coefficient_of_variation : float
        Standard deviation of the marked share over the cells, weighted by their particles, over its mean [1].
    height_separation : float
        Mean height of the marked less that of the others, over that of all [1].
    """
    held = total > 0
    share, weight = marked[held] / total[held], total[held] / total.sum()
    mean = float(share @ weight)
    others = total - marked
    if not 0 < mean < 1:
        return float("nan"), float("nan"), float("nan")
    deviation = float(np.sqrt(weight @ (share - mean) ** 2))
    high = [float(part @ heights_m / part.sum()) for part in (marked, others, total)]
    return lacey_index(marked, total), deviation / mean, (high[0] - high[1]) / high[2]


def variation_limits(total: NDArray[Any], share: float) -> tuple[float, float]:
    """Coefficients of variation of separated particles and of a random mixture, expected [1].

    Parameters
    ----------
    total : (n_cells,) array
        Particles in each cell [1].
    share : float
        Share of the marked among all [1].
    """
    separated = np.sqrt((1 - share) / share)
    return float(separated), float(separated * np.sqrt((total > 0).sum() / total.sum()))
