# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimated cost of a case before it runs, and its actual cost."""
