# SPDX-License-Identifier: GPL-3.0-or-later
# The pipeline of a case, in order: particles and gas, cells, chains, comparison, figures.
#   snakemake --cores 2                        the case `short`, simulated, and `paper`, from its archive
#   snakemake --cores 2 --config case=mueller  one case of cases/
#   ... --config reference=simulate            not from the archive cases/<case>/reference/, but by the solvers
#   ... --config preset=fast                   chains and bed of a preset of cases/presets.yaml, into results/<case>-fast
# A rule gets only the keys of the case that it needs, so a changed key reruns only the rules that use it.
import logging
import sys
from pathlib import Path

from snakemake.script import PythonScript

sys.path.insert(0, f"{workflow.basedir}/scripts")

from bedchain.case.presets import simulated_case
from bedchain.case.two_fluid import is_two_fluid
from bedchain.forked_scripts import share_process
from bedchain.lifetime import begin_run
from bedchain.rule_files import code, source_files
from bedchain.workflow import (
    case_or_exit,
    options_or_exit,
    pick,
    preset_name,
    quote_interpreter,
    reference_or_exit,
    words_or_exit,
)

quote_interpreter()
if not workflow.is_main_process:  # a job's own snakemake repeats no hint
    logging.getLogger("bedchain").setLevel(logging.ERROR)
TYPED = workflow.is_main_process and "snakemake" in Path(sys.argv[0]).parts[-2:]  # sys.argv is a user's line
if TYPED or workflow.remote_exec:  # its jobs end with it, however it ends
    begin_run(submitted=workflow.remote_exec)
if TYPED:
    share_process(PythonScript)
    options_or_exit(sys.argv[1:], workflow.resource_settings.cores, workflow.resource_settings.nodes)

# threads of a rule that must be alone on its machine: all of this one; on a cluster its job takes a whole node
ALONE = workflow.resource_settings.cores or 1
WORDS = words_or_exit(config, workflow.config_settings.config_args)  # of --config
NAME = WORDS.get("case", "short")
PRESET = preset_name(WORDS)
CASE = case_or_exit(NAME, PRESET)
REFERENCE = reference_or_exit(WORDS.get("reference"), NAME, CASE)
CASE = simulated_case(CASE, PRESET, REFERENCE)
WITH_PAPER = "case" not in WORDS and Path("cases/paper/reference").exists()
FOLDER = f"{NAME}-{PRESET}" if PRESET else NAME
RESULTS = f"results/{FOLDER}"
FIGURES = f"results/{FOLDER}/figures"
LOGS = f"logs/{FOLDER}"
BENCHMARKS = f"benchmarks/{FOLDER}"
NETWORK = "network" in CASE  # chains that are written down: no particles, and nothing to learn from
TWO_FLUID = is_two_fluid(CASE)  # gas and solids as two fluids: no particles either
FORMS = {form: f".{form}" for form in ["png", "pdf", "csv"]}
# what people look at, on one page: of both beds where both are made
REPORT = "results/report.html" if WITH_PAPER else f"{RESULTS}/report.html"


KIND = "network" if NETWORK else "two_fluid" if TWO_FLUID else "bed"


include: f"scripts/{KIND}_files.smk"


rule all:
    input:
        CASE_FILES,
        REPORT if WORDS.get("studies", True) else [],


include: f"scripts/{KIND}.smk"


if KIND == "bed":

    include: "scripts/chains.smk"
    include: "scripts/figures.smk"


# The paper's bed by the same rules, named paper_*; the studies and the solver are those of this run.
if WITH_PAPER:

    module paper:
        snakefile:
            "Snakefile"
        config:
            {**WORDS, "case": "paper", "studies": False}

    use rule * from paper exclude build_solver as paper_*


if WORDS.get("studies", True):

    if KIND == "bed":

        include: "scripts/studies.smk"
    include: "scripts/report.smk"


include: "scripts/command_line.smk"
