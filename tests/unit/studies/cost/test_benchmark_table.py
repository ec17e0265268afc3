# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of benchmark_core, by hand."""

from bedchain.studies.cost.benchmark_table import relative_rows, table

ROW = {
    "work": "static counts and matrix", "method": "bedchain", "particles": 81000, "columns": 54, "rows": 210,
    "median_s": 0.5, "cpu_s": 0.0123, "peak_rss_mb": 100.4, "own_rss_mb": 20.0, "entries": 1000, "target": "",
    "met": "",
}  # fmt: skip


def test_rows_show_seconds_or_milliseconds():
    head, rule, line = table([ROW]).split("\n")
    assert head.count("|") == rule.count("|") == line.count("|")
    assert line.split(" | ")[2:8] == ["81,000", "54 x 210", "0.50 s", "12.3 ms", "100 MB", "1,000"]


def test_ratios_by_hand():
    dynamic = ROW | {"work": "dynamic counts and matrix", "method": "dynamic", "median_s": 6.0}
    dynamic |= {"own_rss_mb": 50.0, "entries": 30_000}
    disk = [ROW | {"work": "static counts from disk"} | more for more in (
        {"particles": 81_000, "median_s": 1.0, "cpu_s": 2.0},
        {"particles": 810_000, "median_s": 11.0, "cpu_s": 24.0},
    )]  # fmt: skip
    first, second = relative_rows([ROW, dynamic, *disk])
    assert (
        "12.0 times the time" in first and "2.5 times the memory" in first and "30 times the entries" in first
    )
    assert second == "10 times the particles take 11.0 times the time, 12.0 times that of the processor."
