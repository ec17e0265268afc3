# SPDX-License-Identifier: GPL-3.0-or-later
# The figures, of tables and arrays that the other rules make: one table, and the rule that each of its rows makes.
from bedchain.workflow import cell_size, settled

COLOURS = {source: CASE["figures"][f"{source}_colour"] for source in ["dem", *MODELS]}
CELLS = f"{RESULTS}/cells.npz"
CHAIN_FILES = {"best": "scores_best"}

# A row is a rule, named as its script; its caption is scripts/captions/<rule>.rst. `name` is its figure without .png, .pdf, .csv, with wildcards where one rule
# draws several; `wildcards` says what they may be; a script takes what it is given by name, wildcards too.
FIGURE_RULES = {
    "plot_cells": {
        "name": "fig1_cells",
        "input": {**TRAJECTORY, "cells": CELLS},
        "params": {
            **pick(SIMULATED, "particles.diameter_m"),
            "time_s": CASE["comparison"]["start_s"],
            "colour": CASE["figures"]["cells_colour"],
        },
    },
    "plot_cost": {
        "name": "fig2_cost",
        "input": {
            "timing": f"{RESULTS}/timing.csv",
            "dem": RUN["dem"],
            "provenance": [
                f"{RESULTS}/provenance.json",
                *([f"{REFERENCE}/provenance.json"] if REFERENCE else []),
            ],
        },
        "params": {
            "window_s": CASE["comparison"]["end_s"] - CASE["comparison"]["start_s"],
            "colour": CASE["figures"]["cost_colour"],
        },
    },
    "plot_distribution": {
        "name": "{figure}_{model}",
        "wildcards": {"figure": "fig[34]|fig_distribution", "model": "static|dynamic|chosen|best"},
        "input": {
            "cells": CELLS,
            "chain": lambda wildcards: f"{RESULTS}/{CHAIN_FILES.get(wildcards.model, f'chain_{wildcards.model}')}.npz",
        },
        "params": {
            **pick(CASE, "comparison.start_s", "figures.batch_height_m"),
            "colour_map": CASE["figures"]["distribution_colour_map"],
        },
    },
    "plot_mixing": {
        "name": "{figure}_{direction}",
        "wildcards": {"figure": "fig5[ab]", "direction": "radial|axial"},
        "input": {
            "mixing": f"{RESULTS}/mixing.csv",
            "metrics": f"{RESULTS}/metrics.csv",
            "chains": [f"{RESULTS}/chain_{model}.npz" for model in MODELS],
        },
        "params": {**pick(CASE, "chain.models"), "colours": COLOURS},
    },
    "plot_snapshot": {
        "name": "snapshot",
        "input": {**TRAJECTORY, "dem": RUN["dem"]},
        "params": {
            **pick(SIMULATED, "particles.diameter_m"),
            "time_s": CASE["comparison"]["start_s"],
            "colour_map": CASE["figures"]["snapshot_colour_map"],
        },
    },
    "plot_difference": {
        "name": "fig_difference",
        "input": {"cells": CELLS, **{model: f"{RESULTS}/chain_{model}.npz" for model in MODEL_FIGURES}},
        "params": pick(CASE, "comparison.start_s"),
    },
    "plot_chapman_kolmogorov": {
        "name": "fig_chapman_kolmogorov",
        "input": {"diagnostics": f"{RESULTS}/diagnostics.csv"},
        "params": {"colours": COLOURS},
    },
    "plot_timescales": {
        "name": "fig_timescales",
        "input": {"diagnostics": f"{RESULTS}/diagnostics.csv"},
        "params": {"colours": {model: COLOURS[model] for model in OF_CASE}},
    },
    "plot_choice": {
        "name": "fig_choice",
        "input": {"choice": CHOICE, "curve": f"{RESULTS}/choice_curve.csv"},
    },
    "plot_modes": {
        "name": "fig_modes",
        "input": {"modes": f"{RESULTS}/modes.csv", "cells": CELLS},
    },
    "plot_stationarity": {
        "name": "fig_stationarity",
        "input": {**TRAJECTORY, **SETTLED, "bed_series": RUN["bed_series"]},
        "output": {"stationarity": f"{RESULTS}/stationarity.csv"},
        "params": {
            **pick(SIMULATED, "mixing", "bed.thickness_m", "particles.diameter_m"),
            "start_s": CASE["learning"]["start_s"],
            "end_s": CASE["comparison"]["end_s"],
            "row_m": settled(CASE, lambda case: case["bed"]["height_m"] / case["cells"]["rows"]),
        },
    },
    "plot_bubbles": {
        "name": "fig_bubbles",
        "input": TRAJECTORY,
        "output": {"bubbles": f"{RESULTS}/bubbles.csv"},
        "params": {
            "case": {section: CASE[section] for section in SCENE if section in CASE},
            "start_s": CASE["learning"]["start_s"],
            "end_s": CASE["comparison"]["end_s"],
        },
    },
    "plot_discussion": {
        "name": "fig_discussion",
        "input": {**SETTLED, "discussion": f"{RESULTS}/discussion.csv"},
        "params": {
            "own_cell_m": settled(CASE, cell_size),
            "own_lag_s": settled(CASE, lambda case: case["chain"]["lag_s"]),
            "colours": {model: COLOURS[model] for model in OF_CASE},
        },
    },
}

# of a bed that particles enter and leave, and of marks of a case
FIGURE_RULES |= {
    "plot_segregation": {
        "name": "fig_segregation",
        "input": {"segregation": f"{RESULTS}/segregation.csv"},
        "params": {
            "colours": {
                "dem": COLOURS["dem"],
                "chain": CASE["figures"]["static_colour"],
                "chain_by_mark": CASE["figures"]["dynamic_colour"],
            }
        },
    },
    "plot_scalar": {
        "name": "fig_scalar",
        "input": {"transitions": [f"{RESULTS}/transitions_{model}.npz" for model in STATIC]},
        "params": {
            **CASE.get("scalar", {"wall_loss_1_s": 1.0, "wall_m": 0.0}),
            "colours": {model: COLOURS[model] for model in STATIC},
        },
    },
    "plot_residence": {
        "name": "fig_residence",
        "input": {"residence": f"{RESULTS}/residence.csv"},
        "params": {"colours": {"dem": COLOURS["dem"], "chain": CASE["figures"]["static_colour"]}},
    },
}

# of the studies `scores` and `tradeoff`
if WORDS.get("studies", True):
    FIGURE_RULES |= {
        "plot_pareto": {
            "name": "fig_pareto",
            "input": {**SETTLED, "scores": f"{RESULTS}/scores.csv", "selection": f"{RESULTS}/selection.csv"},
            "params": {
                "baseline_lag_s": settled(CASE, lambda case: case["chain"]["lag_s"]),
                "baseline_cell_m": settled(
                    CASE, lambda case: case["bed"]["width_m"] / case["cells"]["columns"]
                ),
            },
        },
        "plot_ladder": {"name": "fig_ladder", "input": {"ladder": f"{RESULTS}/ladder.csv"}},
        "plot_best_mixing": {
            "name": "fig5_best",
            "input": {"mixing": f"{RESULTS}/scores_mixing.csv", "selection": f"{RESULTS}/selection.csv"},
            "params": pick(CASE, "figures.dem_colour", "figures.static_colour"),
        },
        "plot_autocorrelation": {
            "name": "fig_autocorrelation",
            "input": {"lagrangian": f"{RESULTS}/scores_lagrangian.csv"},
            "params": pick(CASE, "figures.dem_colour"),
        },
        "plot_tradeoff": {"name": "fig_tradeoff", "input": {"tradeoff": f"{RESULTS}/tradeoff.csv"}},
        "plot_variants": {"name": "fig_tradeoff_dem", "input": {"tradeoff": f"{RESULTS}/tradeoff.csv"}},
    }


include: "figure_rules.smk"
