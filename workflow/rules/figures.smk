# One job per figure, from the files of the cases it shows: another case's change does not draw it again.
import json

from disc_model.figures.paper.catalogue import SECTIONS, caption, function_of, label


rule draw_figure:
    input:
        lambda wildcards: map(case_file, CATALOGUE[wildcards.figure].cases),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures of the paper",
            subcategory=lambda wildcards: SECTIONS[
                CATALOGUE[wildcards.figure].section
            ],
            # One label only: Snakemake 9.27's report breaks on two results that differ in two labels.
            labels=lambda wildcards: {"figure": label(wildcards.figure)},
        ),
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(CATALOGUE),
    conda:
        "../envs/disc_model.yaml"
    params:
        caption=lambda wildcards: caption(
            wildcards.figure,
            {name: spec.parameters for name, spec in STUDY.specs.items()},
            {name: spec.sections for name, spec in STUDY.specs.items()},
        ),
        options=lambda wildcards: json.dumps(
            CATALOGUE[wildcards.figure].options, sort_keys=True
        ),
        module=lambda wildcards: module_of(wildcards.figure),
        function=lambda wildcards: function_of(wildcards.figure),
        made_of=lambda wildcards: cases_made_of(CATALOGUE[wildcards.figure].cases),
        sources=lambda wildcards: sources_of(
            "draw_figure", module_of(wildcards.figure), files=[STYLE]
        ),
    shell:
        "python workflow/scripts/draw_figure.py {params.module} {params.function} --options {params.options:q}"
        " --title {params.caption:q} --out {output.pdf} --out {output.png} {input} > {log} 2>&1"


HAS_FIGURE_15 = "fig15" in getattr(GRIDS.get("critical_speed"), "plots", ())

if HAS_FIGURE_15:

    localrules:
        show_figure_15,

    rule show_figure_15:
        # Drawn from a grid study; here it stands among the paper's figures.
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
