# SPDX-License-Identifier: GPL-3.0-or-later
"""Physical constants, the same for all cases."""

GRAVITY_M_S2 = 9.81  # standard value, rounded; along -z
PRESSURE_PA = 101325.0  # of the gas: standard atmosphere
ADIABATIC_INDEX = 1.4  # of air and other diatomic gases
