# SPDX-License-Identifier: GPL-3.0-or-later
# Names and files of a case that is a network: what a run of it makes.
from bedchain.workflow import network_figures

NETWORK_TABLES = {
    name: f"{RESULTS}/{name}.csv"
    for name in ["states", "residence", "pulses", "path", "mixtures", "moves", "axial", "conversion"]
}
CASE_FILES = [
    *expand(f"{FIGURES}/{{name}}{{form}}", name=network_figures(CASE["network"]), form=FORMS.values()),
    *NETWORK_TABLES.values(),
    f"{RESULTS}/metrics.csv",
    f"{RESULTS}/provenance.json",
]
