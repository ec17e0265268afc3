# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts, matrices and the chains made of them."""
