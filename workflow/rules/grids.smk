# Grid studies: batches of points, one dataset for each study, and its figures. Batches are defined in
# disc_model.studies.grid. The name of a batch's file is the hash of its text, so that a value that is removed and
# restored needs no new job.


rule compute_batch:
    output:
        batch_file("{study}", "{batch}"),
    log:
        "results/{study}/logs/compute_batch/{batch}.log",
    conda:
        "../envs/disc_model.yaml"
    resources:
        runtime=30,
    params:
        batch=lambda w: GRIDS[w.study].batches[w.batch],
        code=lambda w: code_of("compute_batch", *BATCHES, own_file(w.study)),
    shell:
        "job compute_batch {output} <<< {params.batch:q} > {log} 2>&1"


rule merge_batches:
    input:
        lambda w: need([batch_file(w.study, x) for x in GRIDS[w.study].batches]),
    output:
        nc="results/{study}/{study}.nc",
        failed="results/{study}/{study}.failed.txt",
        remarks="results/{study}/{study}.remarks.txt",
    log:
        "results/{study}/logs/merge_batches.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        plan=lambda w: GRIDS[w.study].merge_plan.text,
        code=lambda w: code_of("merge_batches", *MERGING, own_file(w.study)),
        folder=lambda w, input: Path(input[0]).parent,
    shell:
        "job merge_batches {output.nc} {output.failed} {output.remarks} {params.folder}"
        " <<< {params.plan:q} > {log} 2>&1"
