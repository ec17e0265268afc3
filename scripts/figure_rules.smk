# SPDX-License-Identifier: GPL-3.0-or-later
# The rules of the figures, of the table FIGURE_RULES of figures.smk or of network.smk.


def figure_rule(plot, row):
    """The rule of one row; a function, since a job of a rule in a plain loop would run the last row's script."""

    rule:
        name:
            plot
        input:
            code(plot),
            **row["input"],
        output:
            **{
                form: (
                    report(
                        f"{FIGURES}/{row['name']}{ending}",
                        caption=f"captions/{plot}.rst",
                        category=f"bed {FOLDER}",
                        subcategory="figures",
                        labels={"figure": row["name"], "form": form},
                    )
                    if form == "png"
                    else f"{FIGURES}/{row['name']}{ending}"
                )
                for form, ending in FORMS.items()
            },
            **row.get("output", {}),
        log:
            f"{LOGS}/{plot}_{row['name']}.log" if "wildcards" in row else f"{LOGS}/{plot}.log",
        wildcard_constraints:
            **row.get("wildcards", {}),
        group:
            "figures"
        conda:
            "../envs/python.yaml"
        params:
            **pick(CASE, "figures.resolution_dpi"),
            **row.get("params", {}),
        script:
            f"{plot}.py"


for plot, row in FIGURE_RULES.items():
    figure_rule(plot, row)
