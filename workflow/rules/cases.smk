# Named cases: one job for each, and all of them on one page. The job receives everything in one text, which Snakemake
# records: a case with equal content is not run again, however its file describes it.
case_file = f"{RESULTS}/cases/{{}}.nc".format


rule simulate_case:
    output:
        case_file("{case}"),
    log:
        f"{RESULTS}/logs/simulate_case/{{case}}.log",
    priority: 1  # short, and first figures need no more
    conda:
        "../envs/disc_model.yaml"
    params:
        case=lambda w: STUDY.cases[w.case].canonical,
        code=physics_hash(),
    shell:
        "job jobs case {output} <<< {params.case:q} > {log} 2>&1"


rule list_cases:
    input:
        list(map(case_file, STUDY.cases)),
    output:
        report(
            f"{RESULTS}/provenance.html",
            caption="../report/provenance.rst",
            category="Provenance",
            labels={"page": "Cases, sources and versions"},
        ),
    log:
        f"{RESULTS}/logs/list_cases.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        # a function, so that braces in a title are no wildcards
        plan=lambda w: json.dumps(
            {"title": STUDY.title or STUDY.study, "labels": STUDY.labels}
        ),
    shell:
        "job jobs provenance {output} {input} <<< {params.plan:q} > {log} 2>&1"


if STUDY.cases:
    PRODUCTS += [*rules.list_cases.output]
