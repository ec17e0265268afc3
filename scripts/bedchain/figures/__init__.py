# SPDX-License-Identifier: GPL-3.0-or-later
"""Style of the figures; pictures for films."""
