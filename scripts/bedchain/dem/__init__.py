# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulation: solver processes, segments with restarts, repeats, the gas case, and results of a run."""
