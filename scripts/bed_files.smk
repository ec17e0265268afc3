# SPDX-License-Identifier: GPL-3.0-or-later
# Names and files of a bed of particles: what its rules share, and what a run of it makes.
from bedchain.case.cell_checks import not_flat
from bedchain.case.chosen import is_auto
from bedchain.case.parcels import parcel_case
from bedchain.case.rank_checks import most_ranks
from bedchain.rule_files import source_files
from bedchain.workflow import solver_values

SIMULATED = parcel_case(CASE)  # with parcels in place of particles, where the case has them
MODELS = CASE["chain"]["models"]
CHOICE = f"{RESULTS}/choice.csv"
SETTLED = {"choice": CHOICE} if is_auto(CASE) else {}  # input of the rules that need the lag or the cells
RANKS = 1 if "frames" in CASE else most_ranks(CASE)
RANKS_GIVEN = "auto --cores {threads}" if CASE.get("run", {}).get("ranks") == "auto" else "{threads}"
REPEATS = range(1, CASE["comparison"]["repeats"] + 1)
SOLVER = "results/bin/bedFoam"
# the bed behind the results, simulated or from its archive: the case's, unless a preset simulates another
OWN_BED = bool(PRESET) and solver_values(CASE) != solver_values(
    simulated_case(case_or_exit(NAME), None, REFERENCE)
)
BED_FOLDER = FOLDER if OWN_BED else NAME
BED = f"results/{BED_FOLDER}"
RUN = {"dem": f"{BED}/dem.json", "bed_series": f"{BED}/bed_series.csv"}
TRAJECTORY = {"trajectory": f"{BED}/trajectory.npy", "metadata": f"{BED}/trajectory.json"}
GAS = CASE["gas"]["model"] != "none"  # without it nothing of OpenFOAM is built or run
FRAMES = "frames" in CASE  # another code's or an experiment's, in place of the simulation
DEM = [] if FRAMES else RUN["dem"]
OPEN = CASE.get("outside") == "exit"  # particles enter and leave
SHAPE = {key: CASE["cells"][key] for key in ("form", "layers") if key in CASE["cells"]}
SHAPE["outside"] = CASE.get("outside", "refuse")
FLAT = not not_flat(**SHAPE)
TRACK = "every_s" in CASE.get("frames", {})  # a few tracers, not located in each frame
MIXES = not (OPEN or TRACK)  # groups of particles stay in the bed, and mix
CLAIMS = source_files(f"cases/{NAME}", "claims.csv")  # about both chains of the paper
MODEL_FIGURES = {"static": "fig3_static", "dynamic": "fig4_dynamic"}
STATIC = [model for model in ("static", "chosen") if model in MODELS]  # chains whose states are cells
PLOTS = [
    "fig1_cells",
    *([] if FRAMES else ["fig2_cost"]),
    *([MODEL_FIGURES[model] for model in MODELS if model in MODEL_FIGURES] if MIXES else []),
    *(["fig_distribution_chosen"] if "chosen" in MODELS and MIXES else []),
    *(["fig5a_radial", "fig5b_axial"] if MIXES else []),
    *(["snapshot"] if GAS else []),
    *(["fig_bubbles"] if GAS and not FRAMES else []),
    *(["fig_difference"] if {*MODEL_FIGURES} <= {*MODELS} and MIXES else []),
    "fig_chapman_kolmogorov",
    *([] if TRACK else ["fig_timescales"]),
    *(["fig_choice"] if MIXES else []),
    *([] if TRACK else ["fig_modes"]),
    "fig_stationarity",
    *(["fig_residence"] if OPEN else []),
    *(["fig_segregation"] if "marks" in CASE else []),
    *(["fig_scalar"] if "scalar" in CASE and STATIC and FLAT else []),
    *(["fig_discussion"] if {*MODEL_FIGURES} & {*MODELS} and FLAT and MIXES else []),
]

TABLES = [
    *(["mixing.csv", "metrics.csv", "choice.csv"] if MIXES else []),
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
CASE_FILES = [
    *expand(f"{FIGURES}/{{name}}{{form}}", name=PLOTS, form=FORMS.values()),
    *([f"{FIGURES}/film.mp4"] if MIXES else []),
    *expand(f"{RESULTS}/{{name}}", name=TABLES),
]
