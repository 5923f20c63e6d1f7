# One job per figure, from the files of its cases or grids: a change of another case does not draw it again.


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def plan_of(wildcards):
    """What a job needs to draw a figure, in JSON, which is ASCII: commands can hold it in any locale."""
    figure = figure_of(wildcards)
    part = figure.plot.kind.rpartition(".")[0]
    own = sorted((WORKFLOW / part).glob("figures*.py")) if part else []
    plan = {
        "plot": figure.plot.model_dump(mode="json"),
        "files": files_of(wildcards),
        "titles": dict(figure.titles),
        "caption": figure.caption,
        "code": figures_hash() + "".join(content_key(file.read_text()) for file in own),
    }
    return json.dumps(plan)


rule draw_figure:
    input:
        lambda w: [*files_of(w).values()],
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
