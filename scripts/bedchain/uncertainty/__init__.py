# SPDX-License-Identifier: GPL-3.0-or-later
"""Error bars, noise floor, deviations of curves, and drifts."""
