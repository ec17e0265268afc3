# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of the solvers and chains: settings at extremes, their outcomes, and the limits by theory."""
