# SPDX-License-Identifier: GPL-3.0-or-later
"""Time that a simulation took for a window, as a row of timing.csv."""

from typing import Any

import numpy as np

from bedchain.errors import UserError

Row = dict[str, Any]


def dem_row(manifest: dict[str, Any], start_s: float, end_s: float) -> Row:
    """Time that the DEM took for a window, segments that stick out of it counted by their part.

    Parameters
    ----------
    manifest : dict
        Of the DEM run.
    start_s, end_s : float
        The window [s].

    Returns
    -------
    dict

    Raises
    ------
    UserError
        The segments do not cover the window.
    """
    wall = cpu = covered = 0.0
    for segment in manifest["segments"]:
        inside = max(0.0, min(end_s, segment["end_s"]) - max(start_s, segment["start_s"]))
        share = inside / (segment["end_s"] - segment["start_s"])
        wall += segment["wall_s"] * share
        # a record of an earlier version has no processor time
        cpu += (segment.get("cpu_s") or segment["wall_s"] * manifest["ranks"]) * share
        covered += inside
    if abs(covered - (end_s - start_s)) > manifest["frame_interval_s"] / 2:
        raise UserError(f"dem.json: its segments cover {covered:g} s of the {end_s - start_s:g} s to compare")
    work = manifest["number"] * (end_s - start_s) / manifest["dem_step_s"]
    return {
        "stage": "dem", "wall_s": wall, "cpu_s": cpu, "peak_rss_mb": np.nan,
        "work": round(work), "work_unit": "particle steps",
    }  # fmt: skip
