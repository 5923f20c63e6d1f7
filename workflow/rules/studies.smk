# Grid studies: batches of points, merged into one dataset for each study. What a batch is, is said in disc_model.studies.grids.schema.
# The name of a batch's file is the hash of all that decides its content, and the name of the merged file is the hash of
# its batches, so that the files that are there tell what is left to do.
import json

COMPILED = source_hash("disc_model.stability.cycle", "disc_model.simulation.api")


rule warm_studies:
    input:
        rules.warm_cache.output,
    output:
        f"results/compiled/studies-{COMPILED}.txt",
    log:
        f"results/compiled/studies-{COMPILED}.log",
    conda:
        "../envs/disc_model.yaml"
    shell:
        "python workflow/scripts/warm_studies.py > {output} 2> {log}"


rule compute_batch:
    input:
        rules.warm_studies.output,
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
        sources=sources_of("merge_batches.py", "disc_model.studies.grids.merge"),
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


rule gc:
    # What no study refers to any more: batches and merged files of former values, options or sources.
    log:
        "results/gc.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    params:
        kept=json.dumps(
            {
                name: [*study.batches, study.key]
                for name, study in sorted(GRIDS.items())
            }
        ),
    shell:
        "python workflow/scripts/gc.py <<< {params.kept:q} 2>&1 | tee {log}"


rule check:
    # What was damaged on the disk, or is there without a record of how it was made: out of the way, to be made anew.
    log:
        "results/check.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    params:
        unrecorded=lambda wildcards: json.dumps(
            unrecorded([*map(case_file, STUDY.specs), *PRODUCTS])
        ),
    shell:
        "python workflow/scripts/check_results.py <<< {params.unrecorded:q} 2>&1 | tee {log}"
