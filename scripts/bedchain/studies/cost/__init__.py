# SPDX-License-Identifier: GPL-3.0-or-later
"""What a case will cost, before it runs, and what it did cost."""
