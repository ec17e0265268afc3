# SPDX-License-Identifier: GPL-3.0-or-later
"""The case: schema, reading, checks, variants, presets, and the parameters of both solvers."""
