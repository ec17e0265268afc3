# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of particle positions: mixing, batches, dispersion, voidage."""
