# SPDX-License-Identifier: GPL-3.0-or-later
"""The recurrence chain: tracers follow the particles through segments of the learning window.

A path goes through the frames of the window and sometimes jumps from a frame to a similar frame
(`frame_distance`). Tracers keep their positions; at each step of the path a tracer takes the displacement of
the particle that is nearest to it in the frame. All tracers share the path, so that whole bubbles pass (the
idea of recurrence CFD: Lichtenegger and Pirker 2016, Chem. Eng. Sci. 153, 394). Assumed: similar states of
the bed have similar futures, and a tracer moves as the nearest particle does. Walls reflect. Two baselines do
not compare frames: ``shuffled`` takes the steps of the window in random order (no memory from step to step),
``replay`` in their own order. All steps weigh the same with every estimator.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.counting import step_starts
from bedchain.chains.frame_distance import FrameFields, frame_fields
from bedchain.chains.nearest_particle import nearest
from bedchain.chains.tracer_chain import Place, TracerChain, reflect, start_places
from bedchain.chains.velocity_binning import measured
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import kept_steps

ORDERS = ("recurrence", "shuffled", "replay")
# Paths averaged for expected values: tracers share a path, so that more tracers cannot replace more paths.
EXPECTED_PATHS = 8


@dataclass(frozen=True)
class RecurrenceSettings:
    """Settings of the path through the window.

    Parameters
    ----------
    order : {"recurrence", "shuffled", "replay"}
        Jumps between similar frames, steps in random order, or the window in order.
    segment_s : float
        Mean time between two jumps [s]; at the end of the window the path always jumps.
    separation_s : float
        Least time between the two frames of a jump [s].
    neighbours : int
        Number of the most similar frames from which the target of a jump is drawn [1].
    coarse_m : float
        Edge of the cells in which frames are compared [m].
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
    """A window of frames, and the rule for the path through it.

    Parameters
    ----------
    grid, lag, lag_s, report
        As `tracer_chain.TracerChain`.
    settings : RecurrenceSettings
    places_m : (2, n_frames, n_particles) float32 array
        Positions x and z in the window [m].
    weights : (n_frames - lag,) int64 array
        Weight of the step from each frame; a step of weight 0 is not used [1].
    fields : FrameFields
        Of the window.

    Raises
    ------
    DataError
        The window is too short for jumps.
    """

    expected_paths = EXPECTED_PATHS

    def __init__(
        self,
        grid: Grid,
        lag: int,
        lag_s: float,
        report: dict[str, float],
        settings: RecurrenceSettings,
        places_m: NDArray[np.float32],
        weights: NDArray[np.int64],
        fields: FrameFields,
    ) -> None:
        super().__init__("recurrence", grid, lag, lag_s, report)
        self.settings, self.places_m, self.weights, self.fields = settings, places_m, weights, fields
        self.usable = np.repeat(np.arange(weights.size), weights)
        self.targets = self._targets() if settings.order == "recurrence" else []

    def walk(self, start: Frames, steps: int, rng: np.random.Generator) -> Iterator[Place]:
        """See `tracer_chain.TracerChain.walk`; only the path is random."""
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
        """First frame of each step; the first is the most similar to the start, or the window's (replay)."""
        if self.settings.order == "shuffled":
            return [int(frame) for frame in rng.choice(self.usable, steps)]
        if self.settings.order == "replay":
            usable = np.unique(self.usable)
            frames = [int(usable[0])]
            while len(frames) < steps:
                after = int(np.searchsorted(usable, frames[-1] + self.lag))
                frames.append(int(usable[after % usable.size]))
            return frames[:steps]
        distances = self.fields.distances_from(self.fields.last_of(start))[: self.weights.size]
        frames = [int(np.where(self.weights > 0, distances, np.inf).argmin())]
        jump = min(1.0, self.lag_s / self.settings.segment_s)
        while len(frames) < steps:
            here = frames[-1] + self.lag
            stop = here >= self.weights.size or self.weights[here] == 0
            frames.append(int(rng.choice(self.targets[here])) if rng.random() < jump or stop else here)
        return frames[:steps]

    def _targets(self) -> list[NDArray[np.int64]]:
        """Targets of a jump from each frame: the most similar frames, each as often as its weight."""
        gap = self.settings.separation_s / (self.lag_s / self.lag)
        targets = []
        for frame, distances in enumerate(self.fields.distances()):
            far = self.usable[np.abs(self.usable - frame) >= max(gap * (1 - 1e-9), 1)]
            targets.append(far[np.argsort(distances[far], kind="stable")][: self.settings.neighbours])
        if min(frames.size for frames in targets) == 0:
            raise DataError(
                f"recurrence: a frame of the window has no other {self.settings.separation_s:g} s or more "
                "away: learn from a longer window or cut separation_s"
            )
        return targets

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
            "coarse": np.array([self.fields.coarse.columns, self.fields.coarse.rows]),
            "scale": self.fields.scale,
            "fields": self.fields.fields,
            "report": np.array(json.dumps(self.report)),
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "RecurrenceChain":
        """Chain from the arrays of `arrays`.

        Raises
        ------
        DataError
            An array is missing.
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
                RecurrenceSettings(str(arrays["order"]), segment, separation, int(neighbours), coarse),
                arrays["places_m"],
                arrays["weights"],
                FrameFields(grids[1], arrays["scale"], arrays["fields"]),
            )
        except KeyError as error:
            raise DataError(f"the file of a chain lacks {error}: build the transitions again") from error


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
        As `registry.learn`; the estimator makes no difference, and the paths do not depend on the grid.
    **settings
        Of `RecurrenceSettings`: order, segment_s, separation_s, neighbours, coarse_m.

    Returns
    -------
    RecurrenceChain
        Its report holds the mean distance of the frames of a jump and of a step, over that of all frames.
    """
    _, weights = step_starts(frames.cells, lag, step_weights=step_weights)
    return _weighted(frames, grid, lag, **settings)(weights)


def relearner(
    frames: Frames, grid: Grid, lag: int = 1, estimator: str = "pooled", **settings: Any
) -> Callable[[NDArray[np.bool_]], RecurrenceChain]:
    """See `registry.relearner`; frames are compared only once. Arguments as `learn`."""
    from_weights, n_steps = _weighted(frames, grid, lag, **settings), len(frames.times_s) - lag
    return lambda kept: from_weights(kept_steps(kept, n_steps))


def _weighted(
    frames: Frames, grid: Grid, lag: int, **settings: Any
) -> Callable[[NDArray[np.int64]], RecurrenceChain]:
    """`learn` as a function of ``step_weights``."""
    checked = RecurrenceSettings(**settings)
    fields = frame_fields(frames, grid, checked.coarse_m)
    places = np.stack([np.asarray(frames.x_m, np.float32), np.asarray(frames.z_m, np.float32)])
    note = {"velocities_from_differences_1": float(not measured(frames))}

    def from_weights(weights: NDArray[np.int64]) -> RecurrenceChain:
        chain = RecurrenceChain(
            grid, lag, lag * frames.interval_s, note.copy(), checked, places, weights, fields
        )
        chain.report |= _report(chain)
        return chain

    return from_weights


def _report(chain: RecurrenceChain) -> dict[str, float]:
    between = chain.fields.distances()
    usual = float(np.sqrt((between**2).mean()))
    jumps = [between[frame, targets].mean() for frame, targets in enumerate(chain.targets)]
    return {
        "steps_1": float((chain.weights > 0).sum()),
        "step_distance_1": float(np.diagonal(between, chain.lag).mean()) / usual if usual else 0.0,
        "jump_distance_1": float(np.mean(jumps)) / usual if jumps and usual else 0.0,
    }
