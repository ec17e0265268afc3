# SPDX-License-Identifier: GPL-3.0-or-later
# The chains: cells, transition matrices, runs, their comparison with the DEM, the film, and tables.
from bedchain.case.parameters import weight_per_area
from bedchain.workflow import table_values

OF_CASE = [model for model in MODELS if model != "chosen"]  # with the lag and the cells of the case
OPTIONS = {model: CASE["chain"].get(model, {}) for model in MODELS}


# The lag and the cells by rule, from the learning window alone: milliseconds.
rule choose_chain:
    input:
        code("choose_chain"),
        **TRAJECTORY,
    output:
        choice=CHOICE,
        curve=f"{RESULTS}/choice_curve.csv",
    log:
        f"{LOGS}/choose_chain.log",
    benchmark:
        f"{BENCHMARKS}/choose_chain.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(SIMULATED, "learning", "mixing", "particles.diameter_m"),
    script:
        "choose_chain.py"


rule assign_cells:
    input:
        code("assign_cells"),
        **TRAJECTORY,
        **SETTLED,
    output:
        cells=f"{RESULTS}/cells.npz",
    log:
        f"{LOGS}/assign_cells.log",
    benchmark:
        f"{BENCHMARKS}/assign_cells.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(SIMULATED, "cells", "particles.diameter_m", "bed.thickness_m"),
        outside=CASE.get("outside", "refuse"),
    script:
        "assign_cells.py"


rule build_transitions:
    input:
        code("build_transitions"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        choice=lambda wildcards: CHOICE if SETTLED or wildcards.model == "chosen" else [],
    output:
        transitions=f"{RESULTS}/transitions_{{model}}.npz",
    log:
        f"{LOGS}/build_transitions_{{model}}.log",
    benchmark:
        f"{BENCHMARKS}/build_transitions_{{model}}.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "learning", "chain.lag_s", "chain.estimator"),
        options=lambda wildcards: OPTIONS[wildcards.model],
    script:
        "build_transitions.py"


rule run_chain:
    input:
        code("run_chain"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=rules.build_transitions.output.transitions,
    output:
        chain=f"{RESULTS}/chain_{{model}}.npz",
    log:
        f"{LOGS}/run_chain_{{model}}.log",
    benchmark:
        f"{BENCHMARKS}/run_chain_{{model}}.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing", "chain.estimator", "chain.seed"),
        **pick(CASE, "figures.batch_height_m", "figures.moments_s"),
        options=lambda wildcards: OPTIONS[wildcards.model],
        learning=CASE["learning"],
    script:
        "run_chain.py"


rule compare_mixing:
    input:
        code("compare_mixing"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        chains=expand(rules.run_chain.output.chain, model=MODELS),
        bed_series=RUN["bed_series"],
        repeats=expand(f"{BED}/repeats/{{repeat}}/mixing.csv", repeat=REPEATS),
    output:
        mixing=f"{RESULTS}/mixing.csv",
        metrics=f"{RESULTS}/metrics.csv",
    log:
        f"{LOGS}/compare_mixing.log",
    benchmark:
        f"{BENCHMARKS}/compare_mixing.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing", "chain.models"),
        **pick(CASE, "figures.batch_height_m"),
        averaged={"start_s": CASE["learning"]["start_s"], "end_s": CASE["comparison"]["end_s"]},
        weight_Pa=weight_per_area(SIMULATED),
    script:
        "compare_mixing.py"


# Of a bed that particles enter and leave (outside: exit).
rule measure_residence:
    input:
        code("measure_residence"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
    output:
        residence=f"{RESULTS}/residence.csv",
    log:
        f"{LOGS}/measure_residence.log",
    benchmark:
        f"{BENCHMARKS}/measure_residence.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "chain.lag_s"),
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "measure_residence.py"


# Of the marks that a case names.
rule measure_segregation:
    input:
        code("measure_segregation"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
    output:
        segregation=f"{RESULTS}/segregation.csv",
    log:
        f"{LOGS}/measure_segregation.log",
    benchmark:
        f"{BENCHMARKS}/measure_segregation.tsv"
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "chain.lag_s", "chain.seed"),
        marks=CASE.get("marks", []),
        folder=f"cases/{NAME}",
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "measure_segregation.py"


# Where frames or cells cannot give all that a simulated bed with flat cells has.
rule list_left_out:
    input:
        code("list_left_out"),
        **TRAJECTORY,
    output:
        left_out=f"{RESULTS}/left_out.csv",
    log:
        f"{LOGS}/list_left_out.log",
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **SHAPE,
        imported=FRAMES,
        track=TRACK,
    script:
        "list_left_out.py"


rule discuss_errors:
    input:
        code("discuss_errors"),
        **TRAJECTORY,
        **SETTLED,
        mixing=rules.compare_mixing.output.mixing,
    output:
        discussion=f"{RESULTS}/discussion.csv",
    log:
        f"{LOGS}/discuss_errors.log",
    benchmark:
        f"{BENCHMARKS}/discuss_errors.tsv"
    priority: 1  # long: the short ones fit beside its end
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "cells", "mixing", "discussion", "chain.lag_s", "chain.estimator"),
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
        names=[model for model in MODEL_FIGURES if model in MODELS],
    script:
        "discuss_errors.py"


rule diagnose_chains:
    input:
        code("diagnose_chains"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=expand(rules.build_transitions.output.transitions, model=OF_CASE),
    output:
        diagnostics=f"{RESULTS}/diagnostics.csv",
        modes=f"{RESULTS}/modes.csv",
    log:
        f"{LOGS}/diagnose_chains.log",
    benchmark:
        f"{BENCHMARKS}/diagnose_chains.tsv"
    priority: 1  # long: the short ones fit beside its end
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "mixing", "chain.estimator", "chain.seed"),
        options=OPTIONS,
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "diagnose_chains.py"


# Alone on the machine, since it measures times.
rule time_models:
    input:
        code("time_models"),
        **TRAJECTORY,
        dem=DEM,
        cells=rules.assign_cells.output.cells,
        transitions=expand(rules.build_transitions.output.transitions, model=MODELS),
    output:
        timing=f"{RESULTS}/timing.csv",
    log:
        f"{LOGS}/time_models.log",
    conda:
        "../envs/python.yaml"
    threads: ALONE
    resources:
        slurm_extra="--exclusive",
    params:
        **pick(CASE, "mixing", "chain.estimator", "chain.seed"),
        options=OPTIONS,
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "time_models.py"


rule make_film:
    input:
        code("make_film"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=expand(f"{RESULTS}/transitions_{{model}}.npz", model=MODELS),
    output:
        film=report(
            f"{FIGURES}/film.mp4",
            caption="captions/make_film.rst",
            category=f"bed {FOLDER}",
            subcategory="film",
            labels={"figure": "film", "form": "mp4"},
        ),
    log:
        f"{LOGS}/make_film.log",
    benchmark:
        f"{BENCHMARKS}/make_film.tsv"
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing.split_x_m", "chain.seed"),
        **pick(SIMULATED, "particles.diameter_m", "bed.thickness_m", "gas.cell_size_m"),
        colours=[CASE["figures"][f"{half}_colour"] for half in ["left", "right"]],
    script:
        "make_film.py"


rule write_table:
    input:
        code("write_table"),
        schema="cases/case.schema.yaml",
    output:
        csv=f"{RESULTS}/table1.csv",
        html=report(
            f"{RESULTS}/table1.html",
            caption="captions/write_table.rst",
            category=f"bed {FOLDER}",
            subcategory="tables",
            labels={"figure": "Table 1", "form": "html"},
        ),
        tex=f"{RESULTS}/table1.tex",
    log:
        f"{LOGS}/write_table.log",
    group:
        "figures"
    conda:
        "../envs/python.yaml"
    params:
        values=table_values(CASE),
        with_paper=bool(CLAIMS),
    script:
        "write_table.py"


# Where a case stands for a publication: its claims, one by one.
rule write_agreement:
    input:
        code("write_agreement"),
        claims=f"cases/{NAME}/claims.csv",
        metrics=rules.compare_mixing.output.metrics,
        mixing=rules.compare_mixing.output.mixing,
        timing=rules.time_models.output.timing,
    output:
        table=f"{RESULTS}/agreement.csv",
    log:
        f"{LOGS}/write_agreement.log",
    group:
        "figures"
    conda:
        "../envs/python.yaml"
    params:
        models=OF_CASE,
    script:
        "write_agreement.py"


rule write_provenance:
    input:
        code("write_provenance"),
        dem=TRAJECTORY["metadata"] if FRAMES else RUN["dem"],
        metrics=rules.compare_mixing.output.metrics if MIXES else [],
        timing=rules.time_models.output.timing,
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
