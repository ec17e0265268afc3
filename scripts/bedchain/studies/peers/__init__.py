# SPDX-License-Identifier: GPL-3.0-or-later
"""Other codes beside bedFoam on the same bed: the same particles, contact law, gas and time steps."""
