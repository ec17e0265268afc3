# SPDX-License-Identifier: GPL-3.0-or-later
"""What accuracy costs: chains of many settings, and beds simulated in many ways, against one reference."""
