# SPDX-License-Identifier: GPL-3.0-or-later
# The figures and the film, of tables and arrays that the other rules made.


rule plot_stationarity:
    input:
        code("plot_stationarity"),
        **TRAJECTORY,
        bed_series=RUN["bed_series"],
    output:
        multiext(f"{FIGURES}/fig_stationarity", **FORMS),
        stationarity=f"{RESULTS}/stationarity.csv",
    log:
        f"{LOGS}/plot_stationarity.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "mixing", "bed.thickness_m", "particles.diameter_m", "figures.resolution_dpi"),
        start_s=CASE["learning"]["start_s"],
        end_s=CASE["comparison"]["end_s"],
        row_m=CASE["bed"]["height_m"] / CASE["cells"]["rows"],
    script:
        "plot_stationarity.py"


rule plot_discussion:
    input:
        code("plot_discussion"),
        discussion=rules.discuss_errors.output.discussion,
    output:
        multiext(f"{FIGURES}/fig_discussion", **FORMS),
    log:
        f"{LOGS}/plot_discussion.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        own_cell_m=cell_size(CASE),
        own_lag_s=CASE["chain"]["lag_s"],
        colours={model: CASE["figures"][f"{model}_colour"] for model in MODELS},
    script:
        "plot_discussion.py"


rule plot_cells:
    input:
        code("plot_cells"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
    output:
        multiext(f"{FIGURES}/fig1_cells", **FORMS),
    log:
        f"{LOGS}/plot_cells.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "particles.diameter_m", "figures.resolution_dpi"),
        time_s=CASE["comparison"]["start_s"],
        colour=CASE["figures"]["cells_colour"],
    script:
        "plot_cells.py"


rule plot_cost:
    input:
        code("plot_cost"),
        timing=rules.time_models.output.timing,
    output:
        multiext(f"{FIGURES}/fig2_cost", **FORMS),
    log:
        f"{LOGS}/plot_cost.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        window_s=CASE["comparison"]["end_s"] - CASE["comparison"]["start_s"],
        colour=CASE["figures"]["cost_colour"],
    script:
        "plot_cost.py"


rule plot_distribution:
    input:
        code("plot_distribution"),
        cells=rules.assign_cells.output.cells,
        chain=lambda wildcards: f"{RESULTS}/{CHAIN_FILES.get(wildcards.model, f'chain_{wildcards.model}')}.npz",
    output:
        multiext(f"{FIGURES}/{{figure,fig[34]|fig_distribution}}_{{model,static|dynamic|best}}", **FORMS),
    log:
        f"{LOGS}/plot_distribution_{{figure}}_{{model}}.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "figures.batch_height_m", "figures.resolution_dpi"),
        model="{model}",
        colour_map=CASE["figures"]["distribution_colour_map"],
    script:
        "plot_distribution.py"


rule plot_mixing:
    input:
        code("plot_mixing"),
        mixing=rules.compare_mixing.output.mixing,
        metrics=rules.compare_mixing.output.metrics,
        chains=expand(rules.run_chain.output.chain, model=MODELS),
    output:
        multiext(f"{FIGURES}/{{figure,fig5[ab]}}_{{direction,radial|axial}}", **FORMS),
    log:
        f"{LOGS}/plot_mixing_{{figure}}_{{direction}}.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "chain.models", "figures.resolution_dpi"),
        direction="{direction}",
        colours={source: CASE["figures"][f"{source}_colour"] for source in ["dem", *MODELS]},
    script:
        "plot_mixing.py"


rule plot_snapshot:
    input:
        code("plot_snapshot"),
        **TRAJECTORY,
        dem=RUN["dem"],
    output:
        multiext(f"{FIGURES}/snapshot", **FORMS),
    log:
        f"{LOGS}/plot_snapshot.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "particles.diameter_m", "figures.resolution_dpi"),
        time_s=CASE["comparison"]["start_s"],
        colour_map=CASE["figures"]["snapshot_colour_map"],
    script:
        "plot_snapshot.py"


rule make_film:
    input:
        code("make_film"),
        **TRAJECTORY,
        cells=rules.assign_cells.output.cells,
        transitions=f"{RESULTS}/transitions_{MODELS[0]}.npz",
    output:
        film=f"{FIGURES}/film.mp4",
    log:
        f"{LOGS}/make_film.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "comparison.start_s", "comparison.end_s", "mixing.split_x_m", "chain.seed"),
        **pick(CASE, "particles.diameter_m", "bed.thickness_m", "gas.cell_size_m"),
        colours=[CASE["figures"][f"{half}_colour"] for half in ["left", "right"]],
    script:
        "make_film.py"


rule plot_difference:
    input:
        code("plot_difference"),
        cells=rules.assign_cells.output.cells,
        static=f"{RESULTS}/chain_static.npz",
        dynamic=f"{RESULTS}/chain_dynamic.npz",
    output:
        multiext(f"{FIGURES}/fig_difference", **FORMS),
    log:
        f"{LOGS}/plot_difference.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
    script:
        "plot_difference.py"


rule plot_chapman_kolmogorov:
    input:
        code("plot_chapman_kolmogorov"),
        diagnostics=rules.diagnose_chains.output.diagnostics,
    output:
        multiext(f"{FIGURES}/fig_chapman_kolmogorov", **FORMS),
    log:
        f"{LOGS}/plot_chapman_kolmogorov.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        colours={source: CASE["figures"][f"{source}_colour"] for source in ["dem", *MODELS]},
    script:
        "plot_chapman_kolmogorov.py"


rule plot_timescales:
    input:
        code("plot_timescales"),
        diagnostics=rules.diagnose_chains.output.diagnostics,
    output:
        multiext(f"{FIGURES}/fig_timescales", **FORMS),
    log:
        f"{LOGS}/plot_timescales.log",
    conda:
        "../envs/python.yaml"
    params:
        **pick(CASE, "figures.resolution_dpi"),
        colours={model: CASE["figures"][f"{model}_colour"] for model in MODELS},
    script:
        "plot_timescales.py"
