# SPDX-License-Identifier: GPL-3.0-or-later
"""The recurrence chain: pieces of the learning window, played one after the other, carry tracers along.

A path goes through the frames of the window and jumps, now and then, from a frame to one that looks alike
(`likeness`); at each step of it a tracer takes the displacement of the particle that is nearest to it in
that frame, and keeps its position. All tracers share the path, so bubbles pass as bubbles (the idea of
recurrence CFD: Lichtenegger and Pirker 2016, Chem. Eng. Sci. 153, 394). Assumed: what follows on alike
states is alike, and a tracer goes as the particle beside it. Walls reflect. Two baselines need no likeness:
``shuffled`` plays the steps in random order (each step real, no memory), ``replay`` plays the window in
order. Steps count alike whatever the estimator.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.counting import step_starts
from bedchain.chains.frame_distance import Likeness, compare
from bedchain.chains.nearest_particle import nearest
from bedchain.chains.tracer_chain import Place, TracerChain, reflect, start_places
from bedchain.chains.velocity_binning import measured
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

ORDERS = ("recurrence", "shuffled", "replay")
# Paths whose mean stands for expected values: tracers share a path, more tracers do not make up for paths.
EXPECTED_PATHS = 8


@dataclass(frozen=True)
class Settings:
    """How the path goes.

    Parameters
    ----------
    order : {"recurrence", "shuffled", "replay"}
        Jumps between alike frames, steps at random, or the window in order.
    segment_s : float
        Mean time between two jumps [s]; the end of the window makes one too.
    separation_s : float
        A jump leads at least so far away in time [s].
    neighbours : int
        A jump leads to any of so many of the most alike frames [1].
    coarse_m : float
        Cells in which frames are compared [m].
    """

    order: str = "recurrence"
    segment_s: float = 0.5
    separation_s: float = 0.25
    neighbours: int = 3
    coarse_m: float = 0.02

    def __post_init__(self) -> None:
        if self.order not in ORDERS:
            raise DataError(f"order {self.order!r} is unknown: choose one of {', '.join(ORDERS)}")
        if not (self.segment_s > 0 and self.separation_s >= 0 and self.coarse_m > 0 and self.neighbours >= 1):
            raise DataError(f"recurrence: lengths, times and numbers must be positive, {self} given")


class RecurrenceChain(TracerChain):
    """A window of frames to be played, and how.

    Parameters
    ----------
    grid, lag, lag_s, report
        As `tracers.TracerChain`.
    settings : Settings
    places_m : (2, n_frames, n_particles) float32 array
        Positions x and z in the window [m].
    weights : (n_frames - lag,) int64 array
        How many times the step from each frame counts; 0 keeps it out.
    likeness : Likeness
        Of the frames.

    Raises
    ------
    DataError
        The window is too short to jump in.
    """

    expected_paths = EXPECTED_PATHS

    def __init__(
        self,
        grid: Grid,
        lag: int,
        lag_s: float,
        report: dict[str, float],
        settings: Settings,
        places_m: NDArray[np.float32],
        weights: NDArray[np.int64],
        likeness: Likeness,
    ) -> None:
        super().__init__("recurrence", grid, lag, lag_s, report)
        self.settings, self.places_m, self.weights, self.likeness = settings, places_m, weights, likeness
        self.usable = np.repeat(np.arange(weights.size), weights)
        self.targets = self._targets() if settings.order == "recurrence" else []

    def walk(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[Place]:
        """See `tracers.TracerChain.walk`; all randomness is in the path."""
        size = np.array([self.grid.width_m, self.grid.height_m])
        tracers = np.stack(start_places(start, self.grid))
        yield tracers[0], tracers[1]
        for frame in self.path(start, steps, rng):
            now, later = self.places_m[:, frame], self.places_m[:, frame + self.lag]
            carrier = nearest(tracers, now, size)
            tracers += (later - now)[:, carrier]
            for axis in (0, 1):
                reflect(tracers[axis], float(size[axis]))
            yield tracers[0], tracers[1]

    def path(self, start: Frames, steps: int, rng: np.random.Generator) -> list[int]:
        """Frames that the steps begin at; the first is the one most like the start (replay: the first)."""
        if self.settings.order == "shuffled":
            return [int(frame) for frame in rng.choice(self.usable, steps)]
        if self.settings.order == "replay":
            once = np.unique(self.usable)
            frames = [int(once[0])]
            while len(frames) < steps:
                after = int(np.searchsorted(once, frames[-1] + self.lag))
                frames.append(int(once[after % once.size]))
            return frames[:steps]
        alike = self.likeness.to(self.likeness.of(start))[: self.weights.size]
        frames = [int(np.where(self.weights > 0, alike, np.inf).argmin())]
        jump = min(1.0, self.lag_s / self.settings.segment_s)
        while len(frames) < steps:
            here = frames[-1] + self.lag
            stop = here >= self.weights.size or self.weights[here] == 0
            frames.append(int(rng.choice(self.targets[here])) if rng.random() < jump or stop else here)
        return frames[:steps]

    def _targets(self) -> list[NDArray[np.int64]]:
        """Frames that a jump from each frame may lead to: the most alike ones, as often as they weigh."""
        gap = self.settings.separation_s / (self.lag_s / self.lag)
        found = []
        for frame, alike in enumerate(self.likeness.distances()):
            far = self.usable[np.abs(self.usable - frame) >= max(gap * (1 - 1e-9), 1)]
            found.append(far[np.argsort(alike[far], kind="stable")][: self.settings.neighbours])
        if min(part.size for part in found) == 0:
            raise DataError(
                f"recurrence: the window holds no frame {self.settings.separation_s:g} s or more away "
                "from one of its frames: learn from a longer window or cut separation_s"
            )
        return found

    def arrays(self) -> dict[str, NDArray[Any]]:
        """See `chain.Chain.arrays`."""
        order, *numbers = astuple(self.settings)
        return {
            "bed_m": np.array([self.grid.width_m, self.grid.height_m]),
            "grid": np.array([self.grid.columns, self.grid.rows]),
            "lag": np.array(self.lag),
            "lag_s": np.array(self.lag_s),
            "order": np.array(order),
            "settings": np.array(numbers, float),
            "places_m": self.places_m,
            "weights": self.weights,
            "coarse": np.array([self.likeness.coarse.columns, self.likeness.coarse.rows]),
            "scale": self.likeness.scale,
            "fields": self.likeness.fields,
            "report": np.array(json.dumps(self.report)),
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "RecurrenceChain":
        """Chain from what `arrays` gave.

        Raises
        ------
        DataError
            Something is missing.
        """
        try:
            width, height = (float(size) for size in arrays["bed_m"])
            grids = [Grid(width, height, *map(int, arrays[name])) for name in ("grid", "coarse")]
            segment, separation, neighbours, coarse = (float(number) for number in arrays["settings"])
            return cls(
                grids[0],
                int(arrays["lag"]),
                float(arrays["lag_s"]),
                json.loads(str(arrays["report"])),
                Settings(str(arrays["order"]), segment, separation, int(neighbours), coarse),
                arrays["places_m"],
                arrays["weights"],
                Likeness(grids[1], arrays["scale"], arrays["fields"]),
            )
        except KeyError as error:
            raise DataError(f"a chain lacks {error}: build the transitions again") from error


def learn(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    **settings: Any,
) -> RecurrenceChain:
    """Recurrence chain from a window of frames.

    Parameters
    ----------
    frames, grid, lag, estimator, step_weights
        As `registry.learn`; the estimator makes no difference, the window does not depend on the grid.
    **settings
        Those of `Settings`: order, segment_s, separation_s, neighbours, coarse_m.

    Returns
    -------
    RecurrenceChain
        Its report holds the mean distance that jumps lead over, and that of a step, over that of all frames.
    """
    _, weights = step_starts(frames.cells, lag, step_weights=step_weights)
    return relearner(frames, grid, lag, estimator, **settings)(weights)


def relearner(
    frames: Frames, grid: Grid, lag: int = 1, estimator: str = "pooled", **settings: Any
) -> Callable[[NDArray[np.int64]], RecurrenceChain]:
    """`learn` as a function of ``step_weights`` that has compared the frames; arguments as `learn`."""
    chosen = Settings(**settings)
    likeness = compare(frames, grid, chosen.coarse_m)
    places = np.stack([np.asarray(frames.x_m, np.float32), np.asarray(frames.z_m, np.float32)])
    note = {"velocities_from_differences_1": float(not measured(frames))}

    def again(weights: NDArray[np.int64]) -> RecurrenceChain:
        chain = RecurrenceChain(
            grid, lag, lag * frames.interval_s, note.copy(), chosen, places, weights, likeness
        )
        chain.report |= _report(chain)
        return chain

    return again


def _report(chain: RecurrenceChain) -> dict[str, float]:
    between = chain.likeness.distances()
    usual = float(np.sqrt((between**2).mean()))
    jumps = [between[frame, targets].mean() for frame, targets in enumerate(chain.targets)]
    return {
        "steps_1": float((chain.weights > 0).sum()),
        "step_distance_1": float(np.diagonal(between, chain.lag).mean()) / usual if usual else 0.0,
        "jump_distance_1": float(np.mean(jumps)) / usual if jumps and usual else 0.0,
    }
