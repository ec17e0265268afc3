# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the small bed that the stage tests share."""

import numpy as np

from bedchain.measures.mixing import Splits
from bedchain.trajectory.frames import Window

WIDTH, HEIGHT, FILLED = 0.08, 0.20, 0.12
NUMBER, DIAMETER = 1500, 1e-3
COLUMNS, ROWS = 8, 20
TIMES = np.round(np.arange(0, 3 + 1e-9, 0.025), 6)
LEARN, COMPARE = Window(0.5, 2.0), Window(2.0, 3.0)
SPLITS, BATCH = Splits(0.04, 0.06), 0.02
MOMENTS = [0.05, 0.30, 0.55]
WEIGHT_PA = 800.0
MODELS = ("static", "dynamic")
