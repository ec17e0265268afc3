# SPDX-License-Identifier: GPL-3.0-or-later
# A case that is a network: its chains are built and run in one job, seconds; then its figures.


from bedchain.workflow import network_inputs


rule run_network:
    input:
        code("run_network"),
        network_inputs(NAME, CASE["network"]),
    output:
        **NETWORK_TABLES,
        metrics=f"{RESULTS}/metrics.csv",
    log:
        f"{LOGS}/run_network.log",
    benchmark:
        f"{BENCHMARKS}/run_network.tsv"
    conda:
        "../envs/python.yaml"
    params:
        network=CASE["network"],
        place=f"cases/{NAME}/case.yaml",
    script:
        "run_network.py"


rule write_provenance:
    input:
        code("write_provenance"),
        metrics=rules.run_network.output.metrics,
    output:
        provenance=f"{RESULTS}/provenance.json",
    log:
        f"{LOGS}/write_provenance.log",
    group:
        "figures"
    conda:
        "../envs/python.yaml"
    params:
        case={section: value for section, value in CASE.items() if section != "figures"},
        benchmarks=BENCHMARKS,
    script:
        "write_provenance.py"


# as in figures.smk
FIGURE_RULES = {
    "plot_network_states": {"name": "fig_states", "input": {"states": NETWORK_TABLES["states"]}},
    "plot_network_residence": {"name": "fig_residence", "input": {"residence": NETWORK_TABLES["residence"]}},
    "plot_network_path": {"name": "fig_path", "input": {"path": NETWORK_TABLES["path"]}},
    "plot_network_pulses": {"name": "fig_pulses", "input": {"pulses": NETWORK_TABLES["pulses"]}},
    "plot_network_mixtures": {"name": "fig_mixtures", "input": {"mixtures": NETWORK_TABLES["mixtures"]}},
    "plot_network_axial": {"name": "fig_axial", "input": {"axial": NETWORK_TABLES["axial"]}},
    "plot_network_conversion": {
        "name": "fig_conversion",
        "input": {"conversion": NETWORK_TABLES["conversion"]},
    },
}


include: "figure_rules.smk"
