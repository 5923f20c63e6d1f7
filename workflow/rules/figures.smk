# One job per figure, from the files of its cases or grids: a change of another case does not draw it again.


rule draw_figure:
    input:
        lambda w: [*files_of(w).values()],
    output:
        pdf="results/{study}/figures/{figure}.pdf",
        png=report(
            "results/{study}/figures/{figure}.png",
            caption="../report/figure.rst",
            category="Figures",
            subcategory=lambda w: figure_of(w).section,
            # One label only: Snakemake 9.27's report breaks on two results that differ in two labels. Without braces:
            # Snakemake takes them for wildcards even here.
            labels=lambda w: {"figure": re.sub("[{}]", "", figure_of(w).title)},
        ),
    log:
        "results/{study}/logs/draw_figure/{figure}.log",
    wildcard_constraints:
        study="|".join(sorted({*GRIDS, STUDY.study})),
        figure="|".join(sorted({name for _, name in FIGURES})) or "none",
    priority: 2  # shown as soon as their data are there
    conda:
        "../envs/disc_model.yaml"
    params:
        plan=plan_of,
        caption=lambda w: figure_of(w).caption,  # for the report
    shell:
        "job jobs figure {output} <<< {params.plan:q} > {log} 2>&1"


for study, figure in FIGURES:
    if study in (STUDY.study, *ASKED):
        PRODUCTS += collect(rules.draw_figure.output, study=study, figure=figure)
