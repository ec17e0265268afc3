# SPDX-License-Identifier: GPL-3.0-or-later
"""Every chain chosen by validation inside the learning window and tested once."""
