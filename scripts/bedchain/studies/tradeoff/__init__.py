# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade-off between cost and accuracy: chains of many settings and variants of the bed, one reference."""
