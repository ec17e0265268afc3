# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the solvers against theory: each runs small cases and compares them with a reference."""
