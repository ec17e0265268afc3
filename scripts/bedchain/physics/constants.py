# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants of nature and of the surroundings that no case changes."""

GRAVITY_M_S2 = 9.81  # standard value, rounded; downwards along z


PRESSURE_PA = 101325.0  # of the gas, no key of the case: standard atmosphere


ADIABATIC_INDEX = 1.4  # of air and other gases of two atoms
