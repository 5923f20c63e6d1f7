# All cases of the study in one file.


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
        labels=LABELS,
        made_of=cases_made_of(sorted(STUDY.specs)),
        sources=sources_of("merge_cases.py", "disc_model.studies.cases.merge"),
    shell:
        "python workflow/scripts/merge_cases.py --labels {params.labels:q} {output} {input} > {log} 2>&1"
