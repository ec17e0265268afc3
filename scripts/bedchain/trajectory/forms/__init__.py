# SPDX-License-Identifier: GPL-3.0-or-later
"""Forms of files with frames of particles, one module a form, all read as the same raw frames."""
