# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured tables of the README files: csv files from results, and from them the tables between marks."""
