# SPDX-License-Identifier: GPL-3.0-or-later
"""Where solvers and chains break: settings at the extremes, how each ends, and the limits by theory."""
