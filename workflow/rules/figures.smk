# One job per figure, from the files of its cases or grids: a change of another case does not draw it again.


rule draw_figure:
    input:
        lambda wildcards: list(files_of(wildcards).values()),
    output:
        pdf="results/{study}/figures/{figure}.pdf",
        png=report(
            "results/{study}/figures/{figure}.png",
            caption="../report/figure.rst",
            category=lambda wildcards: figure_of(wildcards).category,
            subcategory=lambda wildcards: figure_of(wildcards).section,
            # One label only: Snakemake 9.27's report breaks on two results that differ in two labels. Without braces:
            # Snakemake takes them for wildcards even here.
            labels=lambda wildcards: {
                "figure": figure_of(wildcards).title.translate(
                    str.maketrans("", "", "{}")
                )
            },
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
        plot=lambda wildcards: json.dumps(
            figure_of(wildcards).plot.model_dump(mode="json")
        ),
        title=lambda wildcards: json.dumps(figure_of(wildcards).caption),
        caption=lambda wildcards: figure_of(wildcards).caption,
        made_of=lambda wildcards: figure_made_of((wildcards.study, wildcards.figure)),
        files=lambda wildcards: [
            f"{name}={file}" for name, file in files_of(wildcards).items()
        ],
    shell:
        "job draw_figure {params.plot:q} {params.title:q} {output} {params.files:q} > {log} 2>&1"
