# One job per figure, from the files of its cases or grids: a change of another case does not draw it again.


FIGURES = STUDY.entries(GRIDS)


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def figure_made_of(wildcards):
    figure = figure_of(wildcards)
    inputs_made_of = grid_made_of if isinstance(figure.plot, Plot) else case_made_of
    of = [figure.plot.model_dump_json(), *map(inputs_made_of, figure.inputs.values())]
    return made_of("draw_figure", figure.plot.module, of=of)


def figure_names():
    """Names of figures, by the study in whose folder they are."""
    figures = {name: [] for name in (STUDY.name, *GRIDS)}
    for study, name in FIGURES:
        figures[study].append(name)
    return figures


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
    conda:
        "../envs/disc_model.yaml"
    params:
        # JSON is ASCII: commands can hold it in any locale. The caption itself is for the report.
        plot=lambda wildcards: json.dumps(
            figure_of(wildcards).plot.model_dump(mode="json")
        ),
        title=lambda wildcards: json.dumps(figure_of(wildcards).caption),
        caption=lambda wildcards: figure_of(wildcards).caption,
        made_of=lambda wildcards: figure_made_of(wildcards),
        files=lambda wildcards: [
            f"{name}={file}" for name, file in files_of(wildcards).items()
        ],
    shell:
        "job draw_figure {params.plot:q} {params.title:q} {output} {params.files:q} > {log} 2>&1"
