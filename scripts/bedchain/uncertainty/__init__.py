# SPDX-License-Identifier: GPL-3.0-or-later
"""Error bars, noise floors, drifts, and deviations of curves from each other."""
