# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies beside the pipeline: audit, verification, peers, scores, trade-off, stability, cost."""
