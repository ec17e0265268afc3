# SPDX-License-Identifier: GPL-3.0-or-later
"""Markov chains learned from moving particles, and what they cost in accuracy."""
