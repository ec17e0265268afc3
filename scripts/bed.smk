# SPDX-License-Identifier: GPL-3.0-or-later
# The bed: simulated by LIGGGHTS and OpenFOAM in restartable segments, or out of its archive; its frames.
import shlex

from bedchain.dem.repeats import repeat_ranks
from bedchain.studies.cost.job_limits import job_limits
from bedchain.workflow import frame_files, solver_values

DRUM = "liggghts_inputs/drum"
SCENE = ["bed", "particles", "contact", "gas", "drum"]
LIMITS = job_limits(CASE)  # of a cluster's jobs


rule build_solver:
    input:
        script="openfoam_case/solver/build.sh",
        sources=source_files("openfoam_case/solver", "*.C", "*.H"),
    output:
        solver=SOLVER,
    log:
        "logs/build_solver.log",
    priority: 2  # what the particles wait for
    conda:
        "../envs/python.yaml"
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
    priority: 2  # what the particles wait for
    conda:
        "../envs/python.yaml"
    params:
        **solver_values(CASE),
        folder=subpath(output.liggghts, parent=True),
        preset=f"--preset {shlex.quote(PRESET)}" if OWN_BED else "",
    shell:
        "python scripts/write_parameters.py {input.case} {params.folder} {params.preset} 2>&1 | tee {log} >&2"


include: "audit_scene.smk"


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
    priority: 2  # longest of all: what another bed and the repeats have to do fits beside it and after it
    conda:
        "../envs/python.yaml"
    threads: RANKS
    resources:
        **LIMITS["bed"],
    params:
        **pick(CASE, "time.end_s", "time.segment_s"),
        folder=subpath(output.dem, parent=True),
    shell:
        "python scripts/run_dem.py {params.folder} --end {params.end_s} --segment {params.segment_s}"
        f" --ranks {RANKS_GIVEN} 2>&1 | tee {{log}} >&2"


# Another realisation of the comparison window, from a state of the main run that was changed a little. What else waits
# for the main run is short, and fills the core beside an odd repeat.
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
    priority: 1
    conda:
        "../envs/python.yaml"
    threads: repeat_ranks(RANKS, len(REPEATS))
    resources:
        **LIMITS["repeat"],
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "time.segment_s"),
        folder=subpath(input.dem, parent=True),
    shell:
        "python scripts/run_dem.py {params.folder} --repeat {wildcards.repeat} --start {params.start_s}"
        " --end {params.end_s} --segment {params.segment_s} --ranks {threads} 2>&1 | tee {log} >&2"


# Of the main run, and of each repeat in a folder of its own.
rule parse_dumps:
    input:
        code("parse_dumps"),
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
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "bed.width_m", "bed.height_m"),
    script:
        "parse_dumps.py"


rule measure_mixing:
    input:
        code("measure_mixing"),
        trajectory=f"{BED}/repeats/{{repeat}}/trajectory.npy",
        metadata=f"{BED}/repeats/{{repeat}}/trajectory.json",
    output:
        mixing=f"{BED}/repeats/{{repeat}}/mixing.csv",
    log:
        f"{LOGS}/measure_mixing_{{repeat}}.log",
    group:
        "chains"
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing"),
        source="dem_{repeat}",
    script:
        "measure_mixing.py"


# A bed that was simulated before and archived: what run_dem, parse_dumps and the repeats would leave behind.
if REFERENCE:

    ruleorder: unpack_reference > run_dem > parse_dumps > measure_mixing

    rule unpack_reference:
        input:
            code("unpack_reference"),
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
        group:
            "chains"
        conda:
            "../envs/python.yaml"
        script:
            "unpack_reference.py"


# Frames that are there already, of another code or an experiment, in place of run_dem and parse_dumps.
if FRAMES:

    ruleorder: import_frames > run_dem > parse_dumps

    rule import_frames:
        input:
            code("import_frames"),
            files=lambda wildcards: frame_files(NAME, CASE),  # a function: their names are no patterns
        output:
            **TRAJECTORY,
            particles=f"{BED}/particles.npz",
            bed_series=RUN["bed_series"],
            motion=f"{BED}/motion.csv",
        log:
            f"{LOGS}/import_frames.log",
        benchmark:
            f"{BENCHMARKS}/import_frames.tsv"
        conda:
            "../envs/python.yaml"
        threads: 2
        params:
            **pick(CASE, "bed.width_m", "bed.height_m"),
            section=CASE["frames"],
            outside=CASE.get("outside", "refuse"),
            folder=f"cases/{NAME}",
        script:
            "import_frames.py"
