# Grid studies: batches of points, one dataset for each study, and its figures. What a batch is, is said in
# disc_model.studies.study.
# The name of a batch's file is the hash of all that decides its content, and the name of the merged file is the hash of
# its batches, so that the files that are there tell what is left to do.
import json


rule compute_batch:
    input:
        lambda wildcards: compiled(GRIDS[wildcards.study].kernels),
    output:
        batch_file("{study}", "{batch}"),
    log:
        "results/{study}/logs/compute_batch/{batch}.log",
    conda:
        "../envs/disc_model.yaml"
    resources:
        runtime=30,
    params:
        batch=lambda wildcards: GRIDS[wildcards.study].batches[wildcards.batch],
        sources=BATCH_SOURCES,
    shell:
        "python workflow/scripts/compute_batch.py {output} <<< {params.batch:q} > {log} 2>&1"


rule merge_batches:
    input:
        lambda wildcards: [
            batch_file(wildcards.study, batch)
            for batch in GRIDS[wildcards.study].batches
        ],
    output:
        nc="results/{study}/merged/{key}.nc",
        failed="results/{study}/merged/{key}.failed.txt",
    log:
        "results/{study}/logs/merge_batches/{key}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        plan=lambda wildcards: merge_plan(GRIDS[wildcards.study]),
        made_of=BATCH_SOURCES,
        folder=lambda wildcards, input: Path(input[0]).parent,
        sources=sources_of("merge_batches"),
    shell:
        "python workflow/scripts/merge_batches.py {output.nc} {output.failed} {params.folder}"
        " <<< {params.plan:q} > {log} 2>&1"


localrules:
    publish_study,


rule publish_study:
    # Under a name that stays. Nothing in the workflow reads it.
    input:
        nc=lambda wildcards: merged_file(wildcards.study),
        failed=lambda wildcards: merged_file(wildcards.study).replace(
            ".nc", ".failed.txt"
        ),
    output:
        nc="results/{study}/{study}.nc",
        failed="results/{study}/{study}.failed.txt",
    log:
        "results/{study}/logs/publish_study.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        made_of=lambda wildcards: grid_made_of(wildcards.study),
    shell:
        "python workflow/scripts/publish_study.py {input.nc} {input.failed} {output.nc} {output.failed} > {log} 2>&1"


rule draw_plot:
    # One job per figure, from the merged datasets of the studies it shows.
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
                # without braces: Snakemake takes them for wildcards even here
                "figure": f"{GRIDS[wildcards.study].title or wildcards.study}: {wildcards.plot}".translate(
                    str.maketrans("", "", "{}")
                )
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
        "python workflow/scripts/draw_figure.py {params.plot:q} study={input.study} {params.others:q}"
        " --out {output.pdf} --out {output.png} > {log} 2>&1"
