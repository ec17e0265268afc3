# SPDX-License-Identifier: GPL-3.0-or-later
# Names and files of a bed of particles: what its rules share, and what a run of it makes.
from bedchain.case.cell_checks import not_flat
from bedchain.case.chosen import is_auto
from bedchain.workflow import source_files

MODELS = CASE["chain"]["models"]
CHOICE = f"{RESULTS}/choice.csv"
SETTLED = {"choice": CHOICE} if is_auto(CASE) else {}  # input of the rules that need the lag or the cells
REPEATS = range(1, CASE["comparison"]["repeats"] + 1)
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
CASE_FILES = [
    *expand(f"{FIGURES}/{{name}}{{form}}", name=PLOTS, form=FORMS.values()),
    *([] if TRACK else [f"{FIGURES}/film.mp4"]),
    *expand(f"{RESULTS}/{{name}}", name=TABLES),
]
