# Grid studies: batches of points, one dataset for each study, and its figures. Batches are defined in
# disc_model.studies.study. The name of a batch's file is the hash of its text, so that a value that is removed and
# restored needs no new job.
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
        made_of=lambda wildcards: batch_made_of(wildcards.study),
    shell:
        "job compute_batch {output} <<< {params.batch:q} > {log} 2>&1"


rule merge_batches:
    input:
        lambda wildcards: [
            batch_file(wildcards.study, batch)
            for batch in GRIDS[wildcards.study].batches
        ],
    output:
        nc="results/{study}/{study}.nc",
        failed="results/{study}/{study}.failed.txt",
    log:
        "results/{study}/logs/merge_batches.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        plan=lambda wildcards: merge_plan(wildcards.study),
        made_of=lambda wildcards: grid_made_of(wildcards.study),
        folder=lambda wildcards, input: Path(input[0]).parent,
    shell:
        "job merge_batches {output.nc} {output.failed} {params.folder}"
        " <<< {params.plan:q} > {log} 2>&1"


rule draw_plot:
    # One job per figure, from the merged datasets of the studies it shows.
    input:
        study=lambda wildcards: grid_file(wildcards.study),
        others=lambda wildcards: list(overlay_inputs(wildcards).values()),
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
        caption=lambda wildcards: GRIDS[wildcards.study].plots[wildcards.plot].caption,
        made_of=lambda wildcards: plot_made_of(wildcards.study, wildcards.plot),
        files=lambda wildcards, input: [
            f"{role}={file}"
            for role, file in [
                ("study", input.study),
                *overlay_inputs(wildcards).items(),
            ]
        ],
    # '': Snakemake writes nothing at all for an empty caption
    shell:
        "job draw_figure {params.plot:q} ''{params.caption:q} {output} {params.files:q} > {log} 2>&1"
