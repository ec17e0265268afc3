# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured on positions: mixing, batches, dispersion, voidage."""
