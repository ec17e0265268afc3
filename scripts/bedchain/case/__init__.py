# SPDX-License-Identifier: GPL-3.0-or-later
"""The case file: read, completed, checked, varied, and turned into the numbers of both solvers."""
