# SPDX-License-Identifier: GPL-3.0-or-later
# A bed as two fluids on cells of {mm}. Its run is kept in segments: one that was stopped goes on.


rule run_two_fluid:
    input:
        source_files("openfoam_case", "two_fluid/*/*"),
        "openfoam_case/system/blockMeshDict",
        case=ancient(f"cases/{NAME}/case.yaml"),
    output:
        record=f"{BED}/two_fluid/{{mm}}mm/record.json",
    log:
        f"{LOGS}/run_two_fluid_{{mm}}mm.log",
    benchmark:
        f"{BENCHMARKS}/run_two_fluid_{{mm}}mm.tsv"
    wildcard_constraints:
        mm=r"[\d.]+",
    conda:
        "../envs/python.yaml"
    params:
        folder=subpath(output.record, parent=True),
        cell_m=lambda wildcards: float(wildcards.mm) / 1000,
    shell:
        "python scripts/run_two_fluid.py {input.case} {params.folder} --cell {params.cell_m} 2>&1 | tee {log} >&2"
