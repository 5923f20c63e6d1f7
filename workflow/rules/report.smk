# What `snakemake --report` shows besides figures and claims: an overview, where everything comes from, and what the
# normalisation of the modes changes.


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
        title=STUDY.title or STUDY.name,
        made_of=merged_cases_made_of(),
        sources=sources_of("describe_study"),
    shell:
        "python workflow/scripts/describe_study.py {input} {output} --title {params.title:q} > {log} 2>&1"


rule compare_normalisations:
    # Needs the paper's cases under both normalisations: `make orthonormal` computes the second set and asks for this.
    input:
        rules.warm_studies.output,
        published="results/paper/cases.nc",
        orthonormal="results/paper_orthonormal/cases.nc",
    output:
        md="results/paper/normalisation.md",
        html=report(
            "results/paper/normalisation.html",
            caption="../report/normalisation.rst",
            category="Normalisation of the modes",
            labels={"page": "What changes with Eq. (17)"},
        ),
    log:
        "results/paper/logs/compare_normalisations.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        sources=sources_of("compare_normalisations"),
    shell:
        "python workflow/scripts/compare_normalisations.py {input.published} {input.orthonormal} --md {output.md} --html {output.html} > {log} 2>&1"
