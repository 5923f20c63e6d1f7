# Named cases: one job for each, and all of them in one file.

SOLVER = source_hash("disc_model.simulation.api")


rule warm_cache:
    # Compiles the solver once, so that parallel jobs find it in the cache. Named by the sources: with one fixed name
    # the cases would need `ancient`, and Snakemake (9.27) does not look further than a job to be run that is only an
    # ancient input of the next, so changed sources would compile again and simulate nothing.
    output:
        f"results/compiled/{SOLVER}.txt",
    log:
        f"results/compiled/{SOLVER}.log",
    # almost all waits for it; what can be done meanwhile, other kernels, comes after it
    priority: 2
    conda:
        "../envs/disc_model.yaml"
    message:
        "Compiling the solver, once: 15 s on one core. What depends on it waits."
    shell:
        "python -m disc_model warm > {output} 2> {log}"


rule simulate_case:
    # The job is told everything in one text, which Snakemake remembers: a case whose content is the same is not run
    # again, wherever and however its file now says it.
    input:
        rules.warm_cache.output,
    output:
        case_file("{case}"),
    log:
        f"{RESULTS}/logs/simulate_case/{{case}}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        case=lambda wildcards: STUDY.specs[wildcards.case].canonical,
        sources=CASE_SOURCES,
    shell:
        "python workflow/scripts/simulate_case.py {params.case:q} {output} > {log} 2>&1"


rule merge_cases:
    input:
        sorted(map(case_file, STUDY.specs)),
    output:
        f"{RESULTS}/cases.nc",
    log:
        f"{RESULTS}/logs/merge_cases.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        # a function: braces in a title are no wildcards
        labels=lambda wildcards: LABELS,
        made_of=cases_made_of(sorted(STUDY.specs)),
        sources=sources_of("merge_cases"),
    shell:
        "python workflow/scripts/merge_cases.py --labels {params.labels:q} {output} {input} > {log} 2>&1"
