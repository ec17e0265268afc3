# SPDX-License-Identifier: GPL-3.0-or-later
# The pipeline of a case, in order: particles and gas, cells, chains, comparison, figures.
#   snakemake --cores 2                        the case `short`, simulated, and `paper`, from its archive
#   snakemake --cores 2 --config case=mueller  one case of cases/
#   ... --config reference=simulate            not from the archive cases/<case>/reference/, but by the solvers
#   ... --config preset=fast                   chains of a preset of cases/presets.yaml, into results/<case>-fast
# A rule gets only the keys of the case that it needs, so a changed key reruns only the rules that use it.
import atexit
import logging
import sys
from pathlib import Path

from snakemake.cli import get_argument_parser

sys.path.insert(0, f"{workflow.basedir}/scripts")

from bedchain.case.cell_checks import not_flat
from bedchain.case.chosen import is_auto
from bedchain.command_line.failures import failure_report
from bedchain.lifetime import begin_run, end_all_at_sigterm
from bedchain.rule_files import code, source_files
from bedchain.workflow import (
    case_or_exit,
    options_or_exit,
    pick,
    preset_name,
    quote_interpreter,
    reference_or_exit,
    targets_or_exit,
    words_or_exit,
)

quote_interpreter()
if not workflow.is_main_process:  # a job's own snakemake repeats no hint
    logging.getLogger("bedchain").setLevel(logging.ERROR)
TYPED = workflow.is_main_process and "snakemake" in Path(sys.argv[0]).parts[-2:]  # sys.argv is a user's line
if TYPED or workflow.remote_exec:  # its jobs end with it, however it ends
    begin_run(submitted=workflow.remote_exec)
if TYPED:
    options_or_exit(sys.argv[1:], workflow.resource_settings.cores, workflow.resource_settings.nodes)

WORDS = words_or_exit(config, workflow.config_settings.config_args)  # of --config
NAME = WORDS.get("case", "short")
PRESET = preset_name(WORDS)
CASE = case_or_exit(NAME, PRESET)
REFERENCE = reference_or_exit(WORDS.get("reference"), NAME, CASE)
WITH_PAPER = "case" not in WORDS and Path("cases/paper/reference").exists()
FOLDER = f"{NAME}-{PRESET}" if PRESET else NAME
RESULTS = f"results/{FOLDER}"
FIGURES = f"results/{FOLDER}/figures"
LOGS = f"logs/{FOLDER}"
BENCHMARKS = f"benchmarks/{FOLDER}"
MODELS = CASE["chain"]["models"]
CHOICE = f"{RESULTS}/choice.csv"
SETTLED = {"choice": CHOICE} if is_auto(CASE) else {}  # input of the rules that need the lag or the cells
REPEATS = range(1, CASE["comparison"]["repeats"] + 1)
FORMS = {form: f".{form}" for form in ["png", "pdf", "csv"]}
SOLVER = "results/bin/bedFoam"
# the bed behind the results, simulated or from its archive: the same for all presets
BED = f"results/{NAME}"
RUN = {"dem": f"{BED}/dem.json", "bed_series": f"{BED}/bed_series.csv"}
TRAJECTORY = {"trajectory": f"{BED}/trajectory.npy", "metadata": f"{BED}/trajectory.json"}
GAS = CASE["gas"]["model"] != "none"  # without it nothing of OpenFOAM is built or run
FRAMES = "frames" in CASE  # another code's or an experiment's, in place of the simulation
DEM = [] if FRAMES else RUN["dem"]
OPEN = CASE.get("outside") == "exit"  # particles enter and leave
SHAPE = {key: CASE["cells"][key] for key in ("form", "layers") if key in CASE["cells"]}
SHAPE["outside"] = CASE.get("outside", "refuse")
FLAT = not not_flat(**SHAPE)
TRACK = "every_s" in CASE.get("frames", {})  # a few tracers, not located in each frame: no groups that mix
CLAIMS = source_files(f"cases/{NAME}", "claims.csv")  # about both chains of the paper
MODEL_FIGURES = {"static": "fig3_static", "dynamic": "fig4_dynamic"}
PLOTS = [
    "fig1_cells",
    *([] if FRAMES else ["fig2_cost"]),
    *([] if TRACK else [MODEL_FIGURES[model] for model in MODELS if model in MODEL_FIGURES]),
    *(["fig_distribution_chosen"] if "chosen" in MODELS and not TRACK else []),
    *([] if TRACK else ["fig5a_radial", "fig5b_axial"]),
    *(["snapshot"] if GAS else []),
    *(["fig_bubbles"] if GAS and not FRAMES else []),
    *(["fig_difference"] if {*MODEL_FIGURES} <= {*MODELS} and not TRACK else []),
    "fig_chapman_kolmogorov",
    "fig_timescales",
    *([] if TRACK or OPEN else ["fig_choice"]),
    "fig_modes",
    "fig_stationarity",
    *(["fig_residence"] if OPEN else []),
    *(["fig_segregation"] if "marks" in CASE else []),
    *(["fig_discussion"] if {*MODEL_FIGURES} & {*MODELS} and FLAT and not TRACK else []),
]


# what people look at, on one page: of both beds where both are made
REPORT = "results/report.html" if WITH_PAPER else f"{RESULTS}/report.html"
TABLES = [
    *([] if TRACK else ["mixing.csv", "metrics.csv"]),
    *([] if TRACK or OPEN else ["choice.csv"]),
    "diagnostics.csv",
    "stationarity.csv",
    "timing.csv",
    "table1.csv",
    "table1.html",
    *([] if FRAMES else ["audit.csv"]),
    *(["left_out.csv"] if FRAMES or not FLAT else []),
    "provenance.json",
    *(["residence.csv"] if OPEN else []),
    *(["segregation.csv"] if "marks" in CASE else []),
    *(["agreement.csv"] if CLAIMS and {*MODEL_FIGURES} <= {*MODELS} else []),
]
BED_FILES = [
    *expand(f"{FIGURES}/{{name}}{{form}}", name=PLOTS, form=FORMS.values()),
    *([] if TRACK else [f"{FIGURES}/film.mp4"]),
    *expand(f"{RESULTS}/{{name}}", name=TABLES),
]


rule all:
    input:
        BED_FILES,
        REPORT if WORDS.get("studies", True) else [],


include: "scripts/bed.smk"
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

    include: "scripts/studies.smk"
    include: "scripts/report.smk"


# A word that nothing reads ends here, before anything is planned. Snakemake itself gets the targets later.
if TYPED and WORDS.get("studies", True):
    targets_or_exit(
        get_argument_parser().parse_known_args(sys.argv[1:])[0].targets,
        WORDS,
        [rule.name for rule in workflow.rules],
        {NAME, FOLDER, *(["paper"] if WITH_PAPER else [])},
    )


# kill or the end of a terminal ends all jobs within seconds, as Ctrl-C does.
if TYPED:

    onstart:
        end_all_at_sigterm()


# The last line of a run that made the report says where it is.
if TYPED and WORDS.get("studies", True):

    onsuccess:
        if Path(REPORT).exists():
            print(f"Look at {REPORT}: figures, films and tables on one page; it opens in any browser.")


# The cause of a failure stands in the last lines, below snakemake's own.
if workflow.is_main_process:

    onerror:
        atexit.register(print, failure_report(map(Path, log)), file=sys.stderr)
