# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that a run made for people, on one page: report.html."""

from pathlib import Path

from bedchain.figures.report import KINDS, bed_section, report_page
from bedchain.files import write_text
from bedchain.stage import LOG, run_stage


def write_report(files: list[Path], captions: dict[str, str], report: Path) -> None:
    """Write the report of the beds whose files are given.

    Parameters
    ----------
    files : list of Path
        Results of one bed or several; figures and films among them are shown in this order.
    captions : dict of str to str
        File of the caption by a regular expression of the figure's name.
    report : Path
        Html file to make.
    """
    shown = [file for file in files if file.suffix in KINDS]
    folders = dict.fromkeys(file.parent.parent for file in shown)
    texts = {name: Path(text) for name, text in captions.items()}
    beds = [bed_section(bed, texts, [file for file in shown if file.parent.parent == bed]) for bed in folders]
    write_text(report, report_page(beds))
    size = report.stat().st_size / 1e6
    LOG.info("%d figures and films of %d beds in %s, %.0f MB", len(shown), len(beds), report, size)


if rule := globals().get("snakemake"):
    run_stage(write_report, rule)
