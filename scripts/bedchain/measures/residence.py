# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of particles that were seen to come and go, with those that are still inside (censored)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Stays(NamedTuple):
    """Stays of particles in the bed that began in a window of frames.

    Attributes
    ----------
    entered : (n_stays,) int array
        First frame of each stay; the particle was not there in the frame before.
    frames : (n_stays,) int array
        Frames in which it was seen.
    ended : (n_stays,) bool array
        Whether it was seen to end; else the particle is inside in the last frame.
    """

    entered: NDArray[np.int64]
    frames: NDArray[np.int64]
    ended: NDArray[np.bool_]

    def of(self, which: NDArray[np.bool_]) -> "Stays":
        """Some of the stays."""
        return Stays(self.entered[which], self.frames[which], self.ended[which])


def stays(present: NDArray[np.bool_]) -> Stays:
    """Stays that begin in a window; of those that began before it, it is not known when.

    Parameters
    ----------
    present : (n_frames, n_particles) bool array
        Whether each particle is in the bed.
    """
    by_particle = np.asarray(present).T
    last = np.zeros((len(by_particle), 1), bool)
    # entries at frames 1, 2, ...; a stay ends before the first frame without the particle, or with the window
    particle, entered = np.nonzero(by_particle[:, 1:] & ~by_particle[:, :-1])
    of_end, end = np.nonzero(by_particle & ~np.concatenate((by_particle[:, 1:], last), axis=1))
    # the stays of a particle that was there at first have one end more
    first = np.concatenate(([0], np.cumsum(np.bincount(of_end, minlength=len(by_particle)))))
    order = np.concatenate(([0], np.cumsum(np.bincount(particle, minlength=len(by_particle)))))
    number = np.arange(particle.size) - order[particle] + by_particle[particle, 0]
    end = end[first[particle] + number]
    return Stays(entered + 1, end - entered, end < by_particle.shape[1] - 1)


def left_share(observed: Stays, interval_s: float, times_s: NDArray[np.floating]) -> NDArray[np.float64]:
    """F: share of what enters that has left after a time, by the estimator of Kaplan and Meier.

    Stays that are not over count as long as they were seen (Kaplan and Meier 1958, JASA 53, 457).
    A stay of k frames lasts k intervals, on average over when within an interval it begins and ends.

    Parameters
    ----------
    observed : Stays
    interval_s : float
        Time between two frames [s].
    times_s : (n_times,) array
        Times after entering [s].

    Returns
    -------
    (n_times,) array
        [1]; NaN after the longest stay, where that one is not over.
    """
    from scipy import stats  # late: scipy.stats takes a second to load

    lengths = observed.frames * interval_s
    sample = stats.CensoredData.right_censored(lengths, ~observed.ended)
    share = np.asarray(stats.ecdf(sample).cdf.evaluate(times_s + 1e-9 * interval_s))
    longest = int(np.argmax(lengths))
    known = observed.ended[lengths == lengths[longest]].all()
    return share if known else np.where(times_s > lengths[longest], np.nan, share)


def contents_and_feed(present: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Particles in the bed at the start of each interval, and those that enter in it, two (n_frames - 1,)."""
    now = np.asarray(present)
    return now[1:].sum(axis=1), (now[1:] & ~now[:-1]).sum(axis=1)
