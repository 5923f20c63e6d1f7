# One job per figure, from the files of its cases: a change of another case does not draw it again.
import json


rule draw_figure:
    input:
        lambda wildcards: map(case_file, STUDY.figure(wildcards.figure).cases),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=lambda wildcards: STUDY.figure(wildcards.figure).category,
            subcategory=lambda wildcards: STUDY.figure(wildcards.figure).section,
            # One label only: Snakemake 9.27's report breaks on two results that differ in two labels.
            labels=lambda wildcards: {"figure": STUDY.figure(wildcards.figure).label},
        ),
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(STUDY.drawable) or "none",
    conda:
        "../envs/disc_model.yaml"
    params:
        plot=lambda wildcards: STUDY.figure(wildcards.figure).plot.model_dump_json(),
        cases=lambda wildcards: [
            f"{case}={case_file(case)}"
            for case in STUDY.figure(wildcards.figure).cases
        ],
        caption=lambda wildcards: STUDY.figure(wildcards.figure).caption,
        made_of=lambda wildcards: made_of(
            "draw_figure",
            STUDY.figure(wildcards.figure).plot.module,
            of=list(map(case_made_of, STUDY.figure(wildcards.figure).cases)),
        ),
    # '': Snakemake writes nothing at all for an empty caption
    shell:
        "job draw_figure {params.plot:q} ''{params.caption:q} {output} {params.cases:q} > {log} 2>&1"


# A study of cases and a grid of the same name share a folder of figures.
ruleorder: draw_figure > draw_plot


HAS_FIGURE_15 = (
    STUDY.claims
    and "critical_speed" in ASKED
    and "fig15" in GRIDS["critical_speed"].plots
)

if HAS_FIGURE_15:

    localrules:
        show_figure_15,

    rule show_figure_15:
        # Drawn from a grid study, and shown among the paper's figures.
        input:
            pdf="results/critical_speed/figures/fig15.pdf",
            png="results/critical_speed/figures/fig15.png",
        output:
            pdf=f"{RESULTS}/figures/fig15.pdf",
            png=report(
                f"{RESULTS}/figures/fig15.png",
                caption="../report/fig15.rst",
                category="Figures of the paper",
                subcategory=SECTIONS["4.2"],
                labels={"figure": "Fig. 15: Critical speed for separation"},
            ),
        log:
            f"{RESULTS}/logs/show_figure_15.log",
        conda:
            "../envs/disc_model.yaml"
        params:
            made_of=lambda wildcards: plot_made_of("critical_speed", "fig15"),
        shell:
            "(cp {input.pdf} {output.pdf} && cp {input.png} {output.png}) 2> {log}"
