# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of particles: dumps, the store made of them, windows of frames, cells, archives."""
