# SPDX-License-Identifier: GPL-3.0-or-later
"""Generators of the data that tests are made of, and the repository's folder."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
