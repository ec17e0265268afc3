# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains that are written down instead of learned: networks of states, and the models made of them."""
