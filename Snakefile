# SPDX-License-Identifier: GPL-3.0-or-later
# The whole pipeline of one case, in its order: particles and gas, cells, chains, comparison, figures.
#   snakemake --cores 2                        the case `short`, simulated, and `paper`, from its archive
#   snakemake --cores 2 --config case=mueller  one case of cases/
#   ... --config reference=simulate            not from the archive cases/<case>/reference/, but by the solvers
#   ... --config fidelity=fast                 chains of a preset of cases/presets.yaml, into results/<case>-fast
# A rule gets only the keys of the case that it needs: what a changed key does not touch does not run again.
import sys
from pathlib import Path

sys.path.insert(0, f"{workflow.basedir}/scripts")

from bedchain.parameters import weight_per_area
from bedchain.workflow import case_or_exit, cell_size, dated, modules, pick, reference_or_exit
from bedchain.workflow import solver_values, source_files, table_values

NAME = config.get("case", "short")
FIDELITY = config.get("fidelity")
CASE = case_or_exit(NAME, FIDELITY)
REFERENCE = reference_or_exit(config.get("reference"), NAME, CASE)
WITH_PAPER = "case" not in config and Path("cases/paper/reference").exists()
MADE = f"{NAME}-{FIDELITY}" if FIDELITY else NAME
RESULTS = f"results/{MADE}"
FIGURES = f"results/{MADE}/figures"
LOGS = f"logs/{MADE}"
BENCHMARKS = f"benchmarks/{MADE}"
MODELS = CASE["chain"]["models"]
REPEATS = range(1, CASE["comparison"]["repeats"] + 1)
OPTIONS = {model: CASE["chain"].get(model, {}) for model in MODELS}
FORMS = {form: f".{form}" for form in ["png", "pdf", "csv"]}
SOLVER = "results/bin/bedFoam"
# the bed that all is made of, simulated or out of its archive: one for all presets
BED = f"results/{NAME}"
RUN = {"dem": f"{BED}/dem.json", "bed_series": f"{BED}/bed_series.csv"}
TRAJECTORY = {"trajectory": f"{BED}/trajectory.npy", "metadata": f"{BED}/trajectory.json"}
CHAIN_FILES = {"best": "scores_best"}
GAS = CASE["gas"]["model"] != "none"  # without it nothing of OpenFOAM is built or run
CLAIMS = source_files(f"cases/{NAME}", "claims.csv")  # about both chains of the paper
DRUM = "liggghts_inputs/drum"
AUDITED = ["bed", "particles", "contact", "gas", "drum"]
MODEL_FIGURES = {"static": "fig3_static", "dynamic": "fig4_dynamic"}
PLOTS = [
    "fig1_cells",
    "fig2_cost",
    *(MODEL_FIGURES[model] for model in MODELS if model in MODEL_FIGURES),
    "fig5a_radial",
    "fig5b_axial",
    *(["snapshot"] if GAS else []),
    *(["fig_difference"] if {*MODEL_FIGURES} <= {*MODELS} else []),
    "fig_chapman_kolmogorov",
    "fig_timescales",
    "fig_stationarity",
    *(["fig_discussion"] if {*MODEL_FIGURES} & {*MODELS} else []),
]


rule all:
    input:
        (lambda wildcards: rules.paper_all.input) if WITH_PAPER else [],
        expand(f"{FIGURES}/{{name}}{{form}}", name=PLOTS, form=FORMS.values()),
        f"{FIGURES}/film.mp4",
        expand(
            f"{RESULTS}/{{name}}",
            name=[
                "mixing.csv",
                "metrics.csv",
                "diagnostics.csv",
                "stationarity.csv",
                "timing.csv",
                "table1.csv",
                "audit.csv",
                "provenance.json",
                *(["agreement.csv"] if CLAIMS and {*MODEL_FIGURES} <= {*MODELS} else []),
            ],
        ),


rule build_solver:
    input:
        script="openfoam_case/solver/build.sh",
        sources=source_files("openfoam_case/solver", "*.C", "*.H"),
    output:
        solver=SOLVER,
    log:
        "logs/build_solver.log",
    conda:
        "envs/python.yaml"
    threads: 2
    shell:
        "sh {input.script} {output.solver} 2>&1 | tee {log} >&2"


# The case file's own time does not count: only a key that the solvers need makes the particles run again.
rule write_parameters:
    input:
        case=ancient(f"cases/{NAME}/case.yaml"),
    output:
        liggghts=f"{BED}/parameters.lig",
        openfoam=f"{BED}/caseParameters",
    log:
        f"{LOGS}/write_parameters.log",
    conda:
        "envs/python.yaml"
    params:
        **solver_values(CASE),
        folder=subpath(output.liggghts, parent=True),
    shell:
        "python scripts/write_parameters.py {input.case} {params.folder} 2>&1 | tee {log} >&2"


# First of all that can run: what it warns of is read before the particles have taken hours.
rule audit_scene:
    input:
        modules("audit", "case", "scene_numbers", "stage"),
    output:
        audit=f"{RESULTS}/audit.csv",
    log:
        f"{LOGS}/audit_scene.log",
    priority: 1
    conda:
        "envs/python.yaml"
    params:
        case={section: CASE[section] for section in AUDITED if section in CASE},
    script:
        "scripts/audit_scene.py"


# Hours for a large bed, so no edit of a script reruns it. Its state, dem/, is no declared output:
# snakemake deletes the outputs of a job that failed, and the segments must outlive that.
rule run_dem:
    input:
        rules.write_parameters.output,
        solver=SOLVER if GAS else [],
        decks=["liggghts_inputs/in.settle", "liggghts_inputs/in.fluidize"] if GAS else source_files(DRUM, "*"),
        blocks=source_files("liggghts_inputs/include", "*.in"),
        gas=source_files("openfoam_case", "0.orig/*", "constant/*", "system/*") if GAS else [],
    output:
        **RUN,
    log:
        f"{LOGS}/run_dem.log",
    benchmark:
        f"{BENCHMARKS}/run_dem.tsv"
    conda:
        "envs/python.yaml"
    threads: CASE["run"]["ranks"]
    params:
        **pick(CASE, "time.end_s", "time.segment_s"),
        folder=subpath(output.dem, parent=True),
    shell:
        "python scripts/run_dem.py {params.folder} --end {params.end_s} --segment {params.segment_s}"
        " --ranks {threads} 2>&1 | tee {log} >&2"


# Another realisation of the comparison window, from a state of the main run that was changed a little.
rule repeat_dem:
    input:
        rules.write_parameters.output,
        dem=RUN["dem"],
        solver=SOLVER,
        decks=["liggghts_inputs/in.perturb", "liggghts_inputs/in.fluidize"],
        blocks=source_files("liggghts_inputs/include", "*.in"),
    output:
        dem=f"{BED}/repeats/{{repeat}}/dem.json",
        bed_series=f"{BED}/repeats/{{repeat}}/bed_series.csv",
    log:
        f"{LOGS}/repeat_dem_{{repeat}}.log",
    benchmark:
        f"{BENCHMARKS}/repeat_dem_{{repeat}}.tsv"
    conda:
        "envs/python.yaml"
    threads: CASE["run"]["ranks"]
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "time.segment_s"),
        folder=subpath(input.dem, parent=True),
    shell:
        "python scripts/run_dem.py {params.folder} --repeat {wildcards.repeat} --start {params.start_s}"
        " --end {params.end_s} --segment {params.segment_s} --ranks {threads} 2>&1 | tee {log} >&2"


# Of the main run, and of each repeat in a folder of its own.
rule parse_dumps:
    input:
        modules("stage", "trajectory"),
        dem=f"{BED}/{{run}}dem.json",
    output:
        trajectory=f"{BED}/{{run}}trajectory.npy",
        metadata=f"{BED}/{{run}}trajectory.json",
    log:
        f"{LOGS}/{{run}}parse_dumps.log",
    benchmark:
        f"{BENCHMARKS}/{{run}}parse_dumps.tsv"
    wildcard_constraints:
        run="(repeats/[0-9]+/)?",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "bed.width_m", "bed.height_m"),
    script:
        "scripts/parse_dumps.py"


rule measure_mixing:
    input:
        modules("comparison", "frames", "mixing", "stage", "trajectory"),
        trajectory=f"{BED}/repeats/{{repeat}}/trajectory.npy",
        metadata=f"{BED}/repeats/{{repeat}}/trajectory.json",
    output:
        mixing=f"{BED}/repeats/{{repeat}}/mixing.csv",
    log:
        f"{LOGS}/measure_mixing_{{repeat}}.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing"),
        source="dem_{repeat}",
    script:
        "scripts/measure_mixing.py"


# A bed that was simulated before and archived: what run_dem, parse_dumps and the repeats would leave behind.
if REFERENCE:

    ruleorder: unpack_reference > run_dem > parse_dumps > measure_mixing

    rule unpack_reference:
        input:
            modules("archive", "packing", "stage", "trajectory"),
            source_files(REFERENCE, "*"),
            provenance=f"{REFERENCE}/provenance.json",
        output:
            **TRAJECTORY,
            **RUN,
            gas=f"{BED}/gas.npz",
            repeats=expand(rules.measure_mixing.output.mixing, repeat=REPEATS),
        log:
            f"{LOGS}/unpack_reference.log",
        benchmark:
            f"{BENCHMARKS}/unpack_reference.tsv"
        conda:
            "envs/python.yaml"
        params:
            folder=subpath(input.provenance, parent=True),
        script:
            "scripts/unpack_reference.py"


rule assign_cells:
    input:
        modules("cell_store", "grid", "stage", "trajectory"),
        **TRAJECTORY,
    output:
        cells=f"{RESULTS}/cells.npz",
    log:
        f"{LOGS}/assign_cells.log",
    benchmark:
        f"{BENCHMARKS}/assign_cells.tsv"
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "cells", "particles.diameter_m"),
    script:
        "scripts/assign_cells.py"


rule build_transitions:
    input:
        modules("cell_store", "frames", "models", "stage"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
    output:
        transitions=f"{RESULTS}/transitions_{{model}}.npz",
    log:
        f"{LOGS}/build_transitions_{{model}}.log",
    benchmark:
        f"{BENCHMARKS}/build_transitions_{{model}}.tsv"
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "learning", "chain.lag_s", "chain.estimator"),
        options=lambda wildcards: OPTIONS[wildcards.model],
    script:
        "scripts/build_transitions.py"


rule run_chain:
    input:
        modules("blocks", "bootstrap", "cell_store", "distribution", "errors", "frames", "mixing"),
        modules("models", "stage", "storage"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=rules.build_transitions.output.transitions,
    output:
        chain=f"{RESULTS}/chain_{{model}}.npz",
    log:
        f"{LOGS}/run_chain_{{model}}.log",
    benchmark:
        f"{BENCHMARKS}/run_chain_{{model}}.tsv"
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing", "chain.estimator", "chain.seed"),
        **pick(CASE, "figures.batch_height_m", "figures.moments_s"),
        options=lambda wildcards: OPTIONS[wildcards.model],
        learning=CASE["learning"],
    script:
        "scripts/run_chain.py"


rule compare_mixing:
    input:
        modules("cell_store", "comparison", "distribution", "errors", "frames", "mixing", "noise", "stage"),
        modules("storage"),
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
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing", "chain.models"),
        **pick(CASE, "figures.batch_height_m"),
        bed_start_s=CASE["learning"]["start_s"],
        bed_end_s=CASE["comparison"]["end_s"],
        weight_Pa=weight_per_area(CASE),
    script:
        "scripts/compare_mixing.py"


rule plot_stationarity:
    input:
        modules("comparison", "figures", "frames", "stage", "stationarity", "trajectory"),
        **TRAJECTORY,
        bed_series=RUN["bed_series"],
    output:
        multiext(f"{FIGURES}/fig_stationarity", **FORMS),
        stationarity=f"{RESULTS}/stationarity.csv",
    log:
        f"{LOGS}/plot_stationarity.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "mixing", "bed.thickness_m", "particles.diameter_m", "figures.resolution_dpi"),
        start_s=CASE["learning"]["start_s"],
        end_s=CASE["comparison"]["end_s"],
        row_m=CASE["bed"]["height_m"] / CASE["cells"]["rows"],
    script:
        "scripts/plot_stationarity.py"


rule discuss_errors:
    input:
        modules("averaging", "comparison", "frames", "grid", "mixing", "models", "noise", "stage"),
        modules("trajectory"),
        **TRAJECTORY,
        mixing=rules.compare_mixing.output.mixing,
    output:
        discussion=f"{RESULTS}/discussion.csv",
    log:
        f"{LOGS}/discuss_errors.log",
    benchmark:
        f"{BENCHMARKS}/discuss_errors.tsv"
    priority: 1  # long: the short ones fit beside its end
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "cells", "mixing", "discussion", "chain.lag_s", "chain.estimator"),
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
        names=[model for model in MODEL_FIGURES if model in MODELS],
    script:
        "scripts/discuss_errors.py"


rule plot_discussion:
    input:
        modules("errors", "figures", "stage"),
        discussion=rules.discuss_errors.output.discussion,
    output:
        multiext(f"{FIGURES}/fig_discussion", **FORMS),
    log:
        f"{LOGS}/plot_discussion.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        own_cell_m=cell_size(CASE),
        own_lag_s=CASE["chain"]["lag_s"],
        colours={model: CASE["figures"][f"{model}_colour"] for model in MODELS},
    script:
        "scripts/plot_discussion.py"


rule diagnose_chains:
    input:
        modules(
            "blocks",
            "cell_store",
            "counting",
            "diagnosis",
            "diagnostics",
            "estimators",
            "frames",
            "grid",
            "markov_chain",
        ),
        modules("markov_check", "mixing", "models", "passage", "propagation", "stage"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=expand(rules.build_transitions.output.transitions, model=MODELS),
    output:
        diagnostics=f"{RESULTS}/diagnostics.csv",
    log:
        f"{LOGS}/diagnose_chains.log",
    benchmark:
        f"{BENCHMARKS}/diagnose_chains.tsv"
    priority: 1  # long: the short ones fit beside its end
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "mixing", "chain.models", "chain.estimator", "chain.seed"),
        options=OPTIONS,
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "scripts/diagnose_chains.py"


# Alone on the machine, since it measures times.
rule time_models:
    input:
        modules(
            "cell_store", "counting", "dynamic", "errors", "estimators", "frames", "grid", "models", "stage"
        ),
        modules("trajectory"),
        **TRAJECTORY,
        dem=RUN["dem"],
        cells=rules.assign_cells.output.cells,
        transitions=expand(rules.build_transitions.output.transitions, model=MODELS),
    output:
        timing=f"{RESULTS}/timing.csv",
    log:
        f"{LOGS}/time_models.log",
    conda:
        "envs/python.yaml"
    threads: workflow.cores or 1
    params:
        **pick(CASE, "mixing", "chain.models", "chain.estimator", "chain.seed"),
        options=OPTIONS,
        learning=CASE["learning"],
        comparison=pick(CASE, "comparison.start_s", "comparison.end_s"),
    script:
        "scripts/time_models.py"


rule write_table:
    input:
        modules("case", "figures", "stage", "table"),
        schema="cases/case.schema.yaml",
    output:
        table=f"{RESULTS}/table1.csv",
        png=f"{FIGURES}/table1.png",
        pdf=f"{FIGURES}/table1.pdf",
    log:
        f"{LOGS}/write_table.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        values=table_values(CASE),
    script:
        "scripts/write_table.py"


rule plot_cells:
    input:
        modules("cell_store", "figures", "grid", "stage", "trajectory"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
    output:
        multiext(f"{FIGURES}/fig1_cells", **FORMS),
    log:
        f"{LOGS}/plot_cells.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "particles.diameter_m", "figures.resolution_dpi"),
        time_s=CASE["comparison"]["start_s"],
        colour=CASE["figures"]["cells_colour"],
    script:
        "scripts/plot_cells.py"


rule plot_cost:
    input:
        modules("errors", "figures", "stage"),
        timing=rules.time_models.output.timing,
    output:
        multiext(f"{FIGURES}/fig2_cost", **FORMS),
    log:
        f"{LOGS}/plot_cost.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        window_s=CASE["comparison"]["end_s"] - CASE["comparison"]["start_s"],
        colour=CASE["figures"]["cost_colour"],
    script:
        "scripts/plot_cost.py"


rule plot_distribution:
    input:
        modules("cell_store", "diagnostics", "distribution", "figures", "grid", "stage"),
        cells=rules.assign_cells.output.cells,
        chain=lambda wildcards: f"{RESULTS}/{CHAIN_FILES.get(wildcards.model, f'chain_{wildcards.model}')}.npz",
    output:
        multiext(f"{FIGURES}/{{figure,fig[34]|fig_distribution}}_{{model,static|dynamic|best}}", **FORMS),
    log:
        f"{LOGS}/plot_distribution_{{figure}}_{{model}}.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "figures.batch_height_m", "figures.resolution_dpi"),
        model="{model}",
        colour_map=CASE["figures"]["distribution_colour_map"],
    script:
        "scripts/plot_distribution.py"


rule plot_mixing:
    input:
        modules("bootstrap", "errors", "figures", "stage", "storage"),
        mixing=rules.compare_mixing.output.mixing,
        metrics=rules.compare_mixing.output.metrics,
        chains=expand(rules.run_chain.output.chain, model=MODELS),
    output:
        multiext(f"{FIGURES}/{{figure,fig5[ab]}}_{{direction,radial|axial}}", **FORMS),
    log:
        f"{LOGS}/plot_mixing_{{figure}}_{{direction}}.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "chain.models", "figures.resolution_dpi"),
        direction="{direction}",
        colours={source: CASE["figures"][f"{source}_colour"] for source in ["dem", *MODELS]},
    script:
        "scripts/plot_mixing.py"


rule plot_snapshot:
    input:
        modules("cell_store", "figures", "gas_field", "stage", "trajectory"),
        **TRAJECTORY,
        dem=RUN["dem"],
    output:
        multiext(f"{FIGURES}/snapshot", **FORMS),
    log:
        f"{LOGS}/plot_snapshot.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "particles.diameter_m", "figures.resolution_dpi"),
        time_s=CASE["comparison"]["start_s"],
        colour_map=CASE["figures"]["snapshot_colour_map"],
    script:
        "scripts/plot_snapshot.py"


rule make_film:
    input:
        modules("canvas", "cell_store", "figures", "frames", "models", "stage"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=f"{RESULTS}/transitions_{MODELS[0]}.npz",
    output:
        film=f"{FIGURES}/film.mp4",
    log:
        f"{LOGS}/make_film.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing.split_x_m", "chain.seed"),
        **pick(CASE, "particles.diameter_m", "bed.thickness_m", "gas.cell_size_m"),
        colours=[CASE["figures"][f"{half}_colour"] for half in ["left", "right"]],
    script:
        "scripts/make_film.py"


rule plot_difference:
    input:
        modules("cell_store", "diagnostics", "errors", "figures", "grid", "stage", "storage"),
        cells=rules.assign_cells.output.cells,
        static=f"{RESULTS}/chain_static.npz",
        dynamic=f"{RESULTS}/chain_dynamic.npz",
    output:
        multiext(f"{FIGURES}/fig_difference", **FORMS),
    log:
        f"{LOGS}/plot_difference.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
    script:
        "scripts/plot_difference.py"


rule plot_chapman_kolmogorov:
    input:
        modules("errors", "figures", "stage"),
        diagnostics=rules.diagnose_chains.output.diagnostics,
    output:
        multiext(f"{FIGURES}/fig_chapman_kolmogorov", **FORMS),
    log:
        f"{LOGS}/plot_chapman_kolmogorov.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        colours={source: CASE["figures"][f"{source}_colour"] for source in ["dem", *MODELS]},
    script:
        "scripts/plot_chapman_kolmogorov.py"


rule plot_timescales:
    input:
        modules("errors", "figures", "stage"),
        diagnostics=rules.diagnose_chains.output.diagnostics,
    output:
        multiext(f"{FIGURES}/fig_timescales", **FORMS),
    log:
        f"{LOGS}/plot_timescales.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        colours={model: CASE["figures"][f"{model}_colour"] for model in MODELS},
    script:
        "scripts/plot_timescales.py"


# Where a case stands for a publication: its claims, one by one.
rule write_agreement:
    input:
        modules("agreement", "stage"),
        claims=f"cases/{NAME}/claims.csv",
        metrics=rules.compare_mixing.output.metrics,
        mixing=rules.compare_mixing.output.mixing,
        timing=rules.time_models.output.timing,
    output:
        agreement=f"{RESULTS}/agreement.csv",
    log:
        f"{LOGS}/write_agreement.log",
    conda:
        "envs/python.yaml"
    params:
        **pick(CASE, "chain.models"),
    script:
        "scripts/write_agreement.py"


rule write_provenance:
    input:
        modules("case", "provenance", "stage"),
        dem=RUN["dem"],
        metrics=rules.compare_mixing.output.metrics,
        timing=rules.time_models.output.timing,
    output:
        provenance=f"{RESULTS}/provenance.json",
    log:
        f"{LOGS}/write_provenance.log",
    conda:
        "envs/python.yaml"
    params:
        case={section: value for section, value in CASE.items() if section != "figures"},
        benchmarks=BENCHMARKS,
    script:
        "scripts/write_provenance.py"


# The paper's bed by the same rules, named paper_*; the studies and the solver are those of this run.
if WITH_PAPER:

    module paper:
        snakefile:
            "Snakefile"
        config:
            {**config, "case": "paper", "studies": False}

    use rule * from paper exclude build_solver as paper_*


if config.get("studies", True):

    include: "scripts/studies.smk"
