# SPDX-License-Identifier: GPL-3.0-or-later
# Names and files of a bed of two fluids: what a run of it makes.
BED = RESULTS  # no presets
MM = f"{1000 * CASE['gas']['cell_size_m']:g}"
SUMMARY = f"{BED}/two_fluid/{MM}mm"
CASE_FILES = [
    *expand(f"{FIGURES}/fig_two_fluid{{form}}", form=FORMS.values()),
    f"{SUMMARY}/record.json",
    f"{RESULTS}/metrics.csv",
    f"{RESULTS}/audit.csv",
    f"{RESULTS}/provenance.json",
]
