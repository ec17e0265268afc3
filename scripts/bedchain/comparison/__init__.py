# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains beside the DEM: curves, metrics, forecasts, diagnostics, published claims."""
