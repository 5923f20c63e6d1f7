# One job per figure, from the files of the cases it shows: another case's change does not draw it again.


rule draw_figure:
    input:
        lambda wildcards: map(case_file, CATALOGUE[wildcards.figure].cases),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=f"{RESULTS}/figures/{{figure}}.png",
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        sources=lambda wildcards: sources_of(
            "draw_figure.py", module_of(wildcards.figure), files=[STYLE]
        ),
    shell:
        "python workflow/scripts/draw_figure.py {wildcards.figure} --out {output.pdf} --out {output.png} {input}"
        " > {log} 2>&1"
