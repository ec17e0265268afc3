# SPDX-License-Identifier: GPL-3.0-or-later
# A case of two fluids (gas.model: two_fluid): the run and its summary, the audit of the scene, a figure.


include: "audit_scene.smk"
include: "run_two_fluid.smk"


rule write_provenance:
    input:
        code("write_provenance"),
        metrics=f"{RESULTS}/metrics.csv",
    output:
        provenance=f"{RESULTS}/provenance.json",
    log:
        f"{LOGS}/write_provenance.log",
    conda:
        "../envs/python.yaml"
    params:
        case={section: value for section, value in CASE.items() if section != "figures"},
        benchmarks=BENCHMARKS,
    script:
        "write_provenance.py"


# as in figures.smk
FIGURE_RULES = {
    "plot_two_fluid": {
        "name": "fig_two_fluid",
        "input": {"record": f"{SUMMARY}/record.json"},
        "output": {"metrics": f"{RESULTS}/metrics.csv"},
        "params": {"case": CASE},
    },
}


include: "figure_rules.smk"
