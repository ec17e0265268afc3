# SPDX-License-Identifier: GPL-3.0-or-later
"""Scores of all models: each chosen by validation inside the learning window and tested once."""
