# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames read in chunks, and views of memory maps."""

import numpy as np

from bedchain.trajectory import chunks
from made.frames import hopping_cells


def test_views_of_memory_maps_read_the_right_frames(tmp_path):
    np.save(tmp_path / "cells.npy", hopping_cells(7))
    mapped = np.load(tmp_path / "cells.npy", mmap_mode="r")
    for view in (mapped, mapped[4:20], mapped[4:20][3:], mapped[:, 5:], mapped[::2], mapped[[3, 1, 2]]):
        assert (chunks.read_frames(view, 1, 3) == np.asarray(view)[1:3]).all()
