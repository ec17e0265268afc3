# SPDX-License-Identifier: GPL-3.0-or-later
"""One style for all figures; pictures for films."""
