# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts this folder on the path, so that tests in any folder share ``synthetic_bed``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
