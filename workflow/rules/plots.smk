# Figures of grid studies: maps and curves. One job per figure, from the merged datasets of the studies it shows.
rule draw_plot:
    input:
        study=lambda wildcards: merged_file(wildcards.study),
        others=lambda wildcards: list(shown_by(wildcards).values()),
    output:
        pdf="results/{study}/figures/{plot}.pdf",
        png=report(
            "results/{study}/figures/{plot}.png",
            caption="../report/plot.rst",
            category="Maps and curves",
            # One label only, as in figures.smk.
            labels=lambda wildcards: {
                "figure": f"{GRIDS[wildcards.study].title or wildcards.study}: {wildcards.plot}"
            },
        ),
    log:
        "results/{study}/logs/draw_plot/{plot}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        plot=lambda wildcards: GRIDS[wildcards.study]
        .plots[wildcards.plot]
        .model_dump_json(),
        made_of=lambda wildcards: plot_made_of(wildcards.study, wildcards.plot),
        others=lambda wildcards: [
            f"{role}={file}" for role, file in shown_by(wildcards).items()
        ],
    shell:
        "python workflow/scripts/draw_plot.py {params.plot:q} {input.study} {params.others:q}"
        " --out {output.pdf} --out {output.png} > {log} 2>&1"
