# Named cases: one job for each, and all of them in one file and on one page.


rule simulate_case:
    # The job receives everything in one text, which Snakemake records: a case with equal content is not run again,
    # wherever and however its file describes it.
    output:
        case_file("{case}"),
    log:
        f"{RESULTS}/logs/simulate_case/{{case}}.log",
    priority: 1  # short, and first figures need no more
    conda:
        "../envs/disc_model.yaml"
    params:
        case=lambda wildcards: STUDY.specs[wildcards.case].canonical,
        code=code_of("simulate_case", *PHYSICS),
    shell:
        "job simulate_case {params.case:q} {output} > {log} 2>&1"


rule merge_cases:
    input:
        lambda w: need(sorted(map(case_file, STUDY.specs))),
    output:
        nc=f"{RESULTS}/cases.nc",
        html=report(
            f"{RESULTS}/provenance.html",
            caption="../report/provenance.rst",
            category="Provenance",
            labels={"page": "Cases, sources and versions"},
        ),
    log:
        f"{RESULTS}/logs/merge_cases.log",
    priority: 1  # the longest job after a changed case
    conda:
        "../envs/disc_model.yaml"
    params:
        # functions, so that braces in a title are no wildcards; JSON is ASCII
        title=lambda wildcards: PAGE_TITLE,
        labels=lambda wildcards: LABELS,
        code=code_of("merge_cases", *MERGING),
    shell:
        "job merge_cases {params.title:q} {params.labels:q} {output} {input} > {log} 2>&1"
