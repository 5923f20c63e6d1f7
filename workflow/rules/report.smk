# Contents of `snakemake --report` besides figures and claims: an overview and the provenance.


report: "../report/overview.rst"


rule describe_study:
    input:
        rules.merge_cases.output,
    output:
        report(
            f"{RESULTS}/provenance.html",
            caption="../report/provenance.rst",
            category="Provenance",
            labels={"page": "Cases, sources and versions"},
        ),
    log:
        f"{RESULTS}/logs/describe_study.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        # a function, so that braces in a title are no wildcards; JSON, which is ASCII
        title=lambda wildcards: json.dumps(STUDY.title or STUDY.name),
        made_of=made_of("describe_study", of=cases_made_of()),
    shell:
        "job describe_study {params.title:q} {input} {output} > {log} 2>&1"
