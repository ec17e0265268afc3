# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas of plain numbers, each with its source; knows no case and no file."""
