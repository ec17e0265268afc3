# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of particles: dumps, the trajectory of a run, windows of frames, cells, archives."""
