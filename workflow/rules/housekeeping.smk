# Treatment of results that are out of date, or damaged: run by name, not part of `all`.

KEPT = {name: [*x.batches, *x.motions] for name, x in sorted(GRIDS.items())}


rule gc:
    # Removes files that no study refers to any more: batches and merged files of former values, options or sources.
    log:
        "results/gc.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    params:
        kept=json.dumps(KEPT),
    shell:
        "job gc <<< {params.kept:q} 2>&1 | tee {log}"


rule check:
    # Removes files that cannot be read, so that they are computed again.
    log:
        "results/check.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    shell:
        "job check 2>&1 | tee {log}"
