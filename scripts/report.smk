# SPDX-License-Identifier: GPL-3.0-or-later
# The report of a run: one page of all figures, films and tables of its beds, with their captions.
import re

REPORT_FILES = [*CASE_FILES, *(rules.paper_all.input if WITH_PAPER else [])]
# regular expression of the names of a rule's figures -> their caption
CAPTIONS = {
    re.sub(
        r"{(\w+)}", lambda match: f"({row['wildcards'][match[1]]})", row["name"]
    ): f"scripts/captions/{plot}.rst"
    for plot, row in FIGURE_RULES.items()
}


rule write_report:
    input:
        code("write_report"),
        [f"scripts/captions/{plot}.rst" for plot in [*FIGURE_RULES, "make_film"]],
        "scripts/bedchain/figures/report.html",
        files=REPORT_FILES,
    output:
        report=REPORT,
    log:
        f"{LOGS}/write_report.log",
    group:
        "figures"
    conda:
        "../envs/python.yaml"
    params:
        captions={**CAPTIONS, "film": "scripts/captions/make_film.rst"},
    script:
        "write_report.py"
