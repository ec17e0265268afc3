# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulation: processes, segments with their restarts, repeats, the gas case, and what a run leaves."""
