# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of the command line, read as typed and checked before anything is planned."""
