# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas with plain numbers as arguments, each with its source; no case and no file is used."""
