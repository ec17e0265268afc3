# SPDX-License-Identifier: GPL-3.0-or-later
"""Table of the results of benchmark_core in markdown, as the README shows it."""

import os
from pathlib import Path
from typing import Any


def relative_rows(rows: list[dict[str, Any]]) -> list[str]:
    """Sentences on ratios: dynamic to static, and how time grows with the particles."""
    by_work = {(row["work"], row["method"]): row for row in rows}
    static = by_work["static counts and matrix", "bedchain"]
    dynamic = by_work["dynamic counts and matrix", "dynamic"]
    few, many = [row for row in rows if row["work"] == "static counts from disk"]
    growth, busier = (many[time_of] / few[time_of] for time_of in ("median_s", "cpu_s"))
    return [
        f"Dynamic to static matrix: {dynamic['median_s'] / static['median_s']:.1f} times the time "
        "(target <= 20), "
        f"{dynamic['own_rss_mb'] / max(static['own_rss_mb'], 1):.1f} times the memory, "
        f"{dynamic['entries'] / static['entries']:.0f} times the entries (paper: about 1000 times the cost).",
        f"{many['particles'] / few['particles']:.0f} times the particles take {growth:.1f} times the time, "
        f"{busier:.1f} times that of the processor.",
    ]


def table(rows: list[dict[str, Any]]) -> str:
    """The table in markdown."""
    heads = (
        "work",
        "method",
        "particles",
        "cells",
        "median",
        "processor",
        "peak memory",
        "entries",
        "target",
        "met",
    )
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for row in rows:
        times = (row["median_s"], row["cpu_s"])
        shown = [f"{s:.2f} s" if s >= 0.1 else f"{s * 1e3:.1f} ms" for s in times]
        cells = f"{row['columns']} x {row['rows']}"
        labels = (row["work"], row["method"], f"{row['particles']:,}", cells, *shown)
        results = (f"{row['peak_rss_mb']:.0f} MB", f"{row['entries']:,}", row["target"], row["met"])
        lines.append("| " + " | ".join(labels + results) + " |")
    return "\n".join(lines)


def machine() -> str:
    """Processor and cores."""
    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} cores (shared), one used"
