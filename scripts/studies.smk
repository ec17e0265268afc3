# SPDX-License-Identifier: GPL-3.0-or-later
# The studies, each a target of its own beside the pipeline of the Snakefile, whose names they use:
#   verify    the solvers against theory                 peers    bedFoam beside other codes
#   validate  a case against its measured profiles       scores   all chains, chosen by validation, tested once
#   estimate  what a case will cost, before it runs      stability solvers and chains at their extremes
#   tradeoff  what accuracy costs, of chains and of simulated beds; the presets
#   bands     how often the 95 % bands hold the truth
#   presets   cost and error of the case's chains and of the presets
#   ladder    every model on one bed, cost against error
import shlex

from bedchain.case.two_fluid import two_fluid_grids
from bedchain.studies.tradeoff.bed_variants import parcel_beds, variants_or_exit
from bedchain.rule_files import dated
from bedchain.workflow import peers_or_exit

SCORE_PLOTS = ["fig_pareto", "fig5_best", "fig_autocorrelation", "fig_distribution_best"]


# The solvers against theory, on small cases that no case file touches: snakemake --cores 2 verify
rule verify:
    input:
        "results/verify/verification.csv",


rule verify_solver:
    input:
        code("verify_solver"),
        schema="cases/case.schema.yaml",
        solver=SOLVER,
        decks=source_files("liggghts_inputs", "verify/in.*", "include/*.in"),
        gas=source_files("openfoam_case", "0.orig/*", "constant/*", "system/*"),
    output:
        table="results/verify/verification.csv",
        figures=directory("results/verify/figures"),
    log:
        "logs/verify_solver.log",
    benchmark:
        "benchmarks/verify_solver.tsv"
    conda:
        "../envs/python.yaml"
    params:
        folder=subpath(output.table, parent=True),
    shell:
        "python scripts/verify_solver.py --solver {input.solver} --folder {params.folder} 2>&1 | tee {log} >&2"


# bedFoam beside other codes on the same beds: snakemake --cores 2 peers --config peers='{repeats: 5, beds: paper}'
rule peers:
    input:
        "results/peers/peers.csv",


# Alone on the machine, since it measures times. Its finished runs are kept in results/peers/<bed>/.
rule compare_peers:
    input:
        code("compare_peers"),
        source_files("scripts/bedchain/studies/peers/inputs", "*"),
        solver=SOLVER,
        decks=source_files("liggghts_inputs", "in.*", "include/*.in"),
        gas=source_files("openfoam_case", "0.orig/*", "constant/*", "system/*"),
    output:
        table="results/peers/peers.csv",
        ratios="results/peers/ratios.csv",
        text="results/peers/peers.md",
        figure=multiext("results/peers/figures/peers", ".png", ".pdf"),
    log:
        "logs/compare_peers.log",
    conda:
        "../envs/python.yaml"
    threads: ALONE
    resources:
        slurm_extra="--exclusive",
    params:
        folder=subpath(output.table, parent=True),
        options=peers_or_exit(WORDS.get("peers")),  # quoted
    shell:
        "python scripts/compare_peers.py --solver {input.solver} --folder {params.folder} {params.options}"
        " 2>&1 | tee {log} >&2"


# Solvers and chains at their extremes: snakemake --cores 2 stability --config stability=reduced
rule stability:
    input:
        "results/stability/stability.csv",


# What was tried is kept in results/stability/kept: a study that was stopped goes on.
rule study_stability:
    input:
        code("study_stability"),
        schema="cases/case.schema.yaml",
        solver=SOLVER,
        decks=source_files("liggghts_inputs", "in.*", "include/*.in"),
        gas=source_files("openfoam_case", "0.orig/*", "constant/*", "system/*"),
    output:
        table="results/stability/stability.csv",
        figures=directory("results/stability/figures"),
    log:
        "logs/study_stability.log",
    benchmark:
        "benchmarks/study_stability.tsv"
    conda:
        "../envs/python.yaml"
    params:
        folder=subpath(output.table, parent=True),
        extent=WORDS.get("stability", "full"),
    shell:
        "python scripts/study_stability.py --folder {params.folder} --extent {params.extent:q} 2>&1 | tee {log} >&2"


# How often the 95 % bands hold the truth, on processes with a known one and on this run's beds: snakemake --cores 2 bands
BANDS = [NAME, *(["paper"] if WITH_PAPER and NAME != "paper" else [])]


rule bands:
    input:
        "results/bands/coverage.csv",


rule study_bands:
    input:
        code("study_bands"),
        expand("results/{bed}/{file}", bed=BANDS, file=["trajectory.npy", "trajectory.json", "cells.npz"]),
        cases=expand("cases/{bed}/case.yaml", bed=BANDS),
        schema="cases/case.schema.yaml",
    output:
        table="results/bands/coverage.csv",
    log:
        "logs/study_bands.log",
    benchmark:
        "benchmarks/study_bands.tsv"
    conda:
        "../envs/python.yaml"
    params:
        beds=" ".join(BANDS),
    shell:
        "python scripts/study_bands.py --beds {params.beds} --output {output.table} 2>&1 | tee {log} >&2"


# Against measured profiles, where a case has them: snakemake --cores 2 --config case=mueller validate
rule validate:
    input:
        f"{RESULTS}/validation.csv",


rule validate_bed:
    input:
        code("validate_bed"),
        **TRAJECTORY,
        points=f"cases/{NAME}/measured.csv",
        peers=source_files(f"cases/{NAME}", "peers.csv"),
    output:
        multiext(f"{FIGURES}/fig_validation", **FORMS),
        table=f"{RESULTS}/validation.csv",
        metrics=f"{RESULTS}/validation_metrics.csv",
    log:
        f"{LOGS}/validate_bed.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(SIMULATED, "bed.width_m", "bed.thickness_m", "particles.diameter_m"),
        **pick(CASE, "figures.resolution_dpi"),
        start_s=CASE["learning"]["start_s"],
        end_s=CASE["comparison"]["end_s"],
    script:
        "validate_bed.py"


# Every model chosen by validation inside the learning window and tested once: snakemake --cores 2 scores
rule scores:
    input:
        expand(f"{RESULTS}/{{name}}.csv", name=["scores", "selection"]),
        expand(f"{FIGURES}/{{name}}{{form}}", name=SCORE_PLOTS, form=FORMS.values()),


rule score_models:
    input:
        code("score_models"),
        **TRAJECTORY,
        **SETTLED,
        # an archive keeps the repeats' curves, not their positions
        repeats=expand(f"{BED}/repeats/{{repeat}}/trajectory.npy", repeat=[] if REFERENCE else REPEATS),
    output:
        scores=f"{RESULTS}/scores.csv",
        selection=f"{RESULTS}/selection.csv",
        mixing=f"{RESULTS}/scores_mixing.csv",
        lagrangian=f"{RESULTS}/scores_lagrangian.csv",
        best=f"{RESULTS}/scores_best.npz",
    log:
        f"{LOGS}/score_models.log",
    benchmark:
        f"{BENCHMARKS}/score_models.tsv"
    conda:
        "../envs/python.yaml"
    resources:
        mem_mb=LIMITS["chains"]["mem_mb"],
    params:
        **pick(CASE, "cells", "chain.lag_s", "chain.estimator", "chain.seed", "mixing"),
        **pick(SIMULATED, "particles.diameter_m", "figures.batch_height_m", "figures.moments_s"),
        outside=CASE.get("outside", "refuse"),
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "score_models.py"


# The case's own chains and the presets, from several starts beside another DEM run: snakemake --cores 2 presets
rule presets:
    input:
        f"{RESULTS}/preset_errors.csv",


# Alone on the machine, since it measures times.
rule score_presets:
    input:
        code("score_presets"),
        **TRAJECTORY,
        # an archive keeps the repeats' curves, not their positions
        repeats=expand(f"{BED}/repeats/{{repeat}}/trajectory.npy", repeat=[] if REFERENCE else REPEATS),
        curves=expand(rules.measure_mixing.output.mixing, repeat=REPEATS),
        choice=CHOICE,
        presets="cases/presets.yaml",
    output:
        table=f"{RESULTS}/preset_errors.csv",
    log:
        f"{LOGS}/score_presets.log",
    benchmark:
        f"{BENCHMARKS}/score_presets.tsv"
    conda:
        "../envs/python.yaml"
    threads: ALONE
    resources:
        slurm_extra="--exclusive",
    params:
        case=CASE,
    script:
        "score_presets.py"


# Every model on one bed, cost against error: snakemake --cores 2 ladder. Two-fluid runs come out of the case's archive
# (cases/<case>/two_fluid) or are made, on two grids, where the bed can be one of two fluids.
ARCHIVED_TWO_FLUID = source_files(f"cases/{NAME}", "two_fluid/*/record.json")
TWO_FLUID_MM = [] if ARCHIVED_TWO_FLUID else two_fluid_grids(CASE)
# the same bed of parcels, where it is simulated; one that ran elsewhere is in cases/<case>/ladder
PARCEL_BEDS = {} if REFERENCE or FRAMES else parcel_beds(CASE)


rule ladder:
    input:
        f"{RESULTS}/ladder.csv",
        expand(f"{FIGURES}/fig_ladder{{form}}", form=FORMS.values()),


include: "run_two_fluid.smk"


rule answer_bed:
    input:
        code("answer_bed"),
        record=f"{RESULTS}/tradeoff/{{variant}}/variant.json",
        choice=list(SETTLED.values()),
    output:
        answer=f"{RESULTS}/ladder/{{variant}}.json",
    log:
        f"{LOGS}/answer_bed_{{variant}}.log",
    wildcard_constraints:
        variant=r"[\w.-]+",
    conda:
        "../envs/python.yaml"
    params:
        model=lambda wildcards: f"bedFoam, {PARCEL_BEDS[wildcards.variant]}",
    script:
        "answer_bed.py"


# Alone on the machine, since it measures times.
rule study_ladder:
    input:
        code("study_ladder"),
        **TRAJECTORY,
        cells=f"{RESULTS}/cells.npz",
        dem=RUN["dem"],
        bed_series=RUN["bed_series"],
        mixing=f"{RESULTS}/mixing.csv",
        choice=CHOICE,
        two_fluid=ARCHIVED_TWO_FLUID + expand(f"{BED}/two_fluid/{{mm}}mm/record.json", mm=TWO_FLUID_MM),
        others=source_files(f"cases/{NAME}", "ladder/*.json")
        + expand(rules.answer_bed.output.answer, variant=PARCEL_BEDS),
    output:
        ladder=f"{RESULTS}/ladder.csv",
    log:
        f"{LOGS}/study_ladder.log",
    benchmark:
        f"{BENCHMARKS}/study_ladder.tsv"
    conda:
        "../envs/python.yaml"
    threads: ALONE
    resources:
        slurm_extra="--exclusive",
    params:
        case=CASE,
    script:
        "study_ladder.py"


# What a case will cost, before it runs; after a run also what it did cost: snakemake --cores 2 estimate
rule estimate:
    input:
        text=f"{RESULTS}/estimate.txt",
    log:
        f"{LOGS}/estimate.log",
    conda:
        "../envs/python.yaml"
    shell:
        "tee {log} < {input.text}"


# What it reads is no input of it: an estimate must not make what it estimates.
rule estimate_cost:
    input:
        code("estimate_cost"),
    output:
        table=f"{RESULTS}/estimate.csv",
        text=f"{RESULTS}/estimate.txt",
    log:
        f"{LOGS}/estimate_cost.log",
    conda:
        "../envs/python.yaml"
    params:
        case=CASE,
        bed=BED_FOLDER,
        benchmarks={"bed": f"benchmarks/{BED_FOLDER}", "made": BENCHMARKS},
        archived=REFERENCE is not None,
        presets="cases/presets.yaml",
        records=dated(
            "results/*/dem.json", f"{BENCHMARKS}/*.tsv", f"{RESULTS}/metrics.csv", "cases/presets.yaml"
        ),
    script:
        "estimate_cost.py"


# What accuracy costs: chains of many settings, and the bed simulated in many ways. What was finished is kept.
#   snakemake --cores 2 tradeoff --config tradeoff='{dem: [base, friction_0]}'     (or all, none)
VARIANTS = variants_or_exit(WORDS.get("tradeoff"), CASE, bool(REFERENCE))
TRADEOFF_PLOTS = ["fig_tradeoff", *(["fig_tradeoff_dem"] if VARIANTS else [])]


rule tradeoff:
    input:
        f"{RESULTS}/presets.yaml",
        expand(f"{FIGURES}/{{name}}{{form}}", name=TRADEOFF_PLOTS, form=FORMS.values()),


# Hours for a large bed, so no edit of a script reruns it; its state is kept in segments, as that of run_dem.
rule run_variant:
    input:
        case=ancient(f"cases/{NAME}/case.yaml"),
        solver=rules.run_dem.input.solver,
        decks=rules.run_dem.input.decks,
        blocks=rules.run_dem.input.blocks,
        gas=rules.run_dem.input.gas,
    output:
        record=f"{RESULTS}/tradeoff/{{variant}}/variant.json",
    log:
        f"{LOGS}/run_variant_{{variant}}.log",
    wildcard_constraints:
        variant=r"[\w.-]+",
    conda:
        "../envs/python.yaml"
    resources:
        **LIMITS["variant"],
    params:
        **solver_values(CASE),
        folder=subpath(output.record, parent=True),
    shell:
        "python scripts/run_variant.py {input.case} {params.folder} 2>&1 | tee {log} >&2"


# Alone on the machine, since it measures times.
rule study_tradeoff:
    input:
        code("study_tradeoff"),
        **TRAJECTORY,
        **SETTLED,
        case=ancient(f"cases/{NAME}/case.yaml"),
        bed_series=RUN["bed_series"],
        repeats=expand(rules.measure_mixing.output.mixing, repeat=REPEATS),
        # an archive keeps the repeats' curves, not their positions
        moving=expand(f"{BED}/repeats/{{repeat}}/trajectory.npy", repeat=[] if REFERENCE else REPEATS),
        variants=expand(rules.run_variant.output.record, variant=VARIANTS),
    output:
        table=f"{RESULTS}/tradeoff.csv",
        presets=f"{RESULTS}/presets.yaml",
    log:
        f"{LOGS}/study_tradeoff.log",
    benchmark:
        f"{BENCHMARKS}/study_tradeoff.tsv"
    conda:
        "../envs/python.yaml"
    threads: ALONE
    resources:
        slurm_extra="--exclusive",
    params:
        **pick(CASE, "cells", "chain.lag_s", "chain.models", "chain.estimator", "chain.seed", "mixing"),
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
        folder=subpath(output.table, parent=True),
        variants=" ".join(VARIANTS),
    shell:
        "python scripts/study_tradeoff.py {input.case} {params.folder} --log {log} --variants {params.variants}"


# Tables and pictures of the README files, from the csv files beside them: snakemake --cores 2 readme. The csv files of
# a case or a study are made first where one is named: --config case=short, --config study=verify. What it reads is
# no input of it: a README must not run what it shows.
rule readme:
    input:
        code("write_readme"),
    log:
        "logs/write_readme.log",
    conda:
        "../envs/python.yaml"
    params:
        options=shlex.join(f"--{key}={WORDS[key]}" for key in ("case", "study") if key in WORDS),
    shell:
        "python scripts/write_readme.py --log {log} {params.options}"
