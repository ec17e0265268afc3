# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts, transition matrices and the chains learned from them."""
