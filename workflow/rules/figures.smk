# One job per figure, from the files of its cases or grids: a change of another case does not draw it again.


rule draw_figure:
    input:
        lambda w: need([*files_of(w).values()]),
    output:
        pdf="results/{study}/figures/{figure}.pdf",
        png=report(
            "results/{study}/figures/{figure}.png",
            caption="../report/figure.rst",
            category=lambda w: figure_of(w).category,
            subcategory=lambda w: figure_of(w).section,
            # One label only: Snakemake 9.27's report breaks on two results that differ in two labels. Without braces:
            # Snakemake takes them for wildcards even here.
            labels=lambda w: {"figure": re.sub("[{}]", "", figure_of(w).title)},
        ),
    log:
        "results/{study}/logs/draw_figure/{figure}.log",
    wildcard_constraints:
        study="|".join(sorted({*GRIDS, STUDY.name})),
        figure="|".join(sorted({name for _, name in FIGURES})) or "none",
    priority: 2  # shown as soon as their data are there
    conda:
        "../envs/disc_model.yaml"
    params:
        # JSON is ASCII: commands can hold it in any locale. The caption itself is for the report.
        plot=lambda w: json.dumps(figure_of(w).plot.model_dump(mode="json")),
        titles=lambda w: json.dumps(dict(figure_of(w).titles)),
        title=lambda w: json.dumps(figure_of(w).caption),
        caption=lambda w: figure_of(w).caption,
        code=lambda w: code_of("draw_figure", *drawing_of(w)),
        files=lambda w: [f"{name}={file}" for name, file in files_of(w).items()],
    shell:
        "job draw_figure {params.plot:q} {params.titles:q} {params.title:q} {output} {params.files:q} > {log} 2>&1"
