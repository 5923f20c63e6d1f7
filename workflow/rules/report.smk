# Contents of `snakemake --report` besides figures and claims: an overview, the provenance, the effect of the
# normalisation of the modes, and the conclusions that hold under other models.


from disc_model.paper import SURVIVAL_GRIDS


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


rule compare_normalisations:
    # Needs the paper's cases under both normalisations: `make orthonormal` computes the second set and runs this.
    input:
        compiled(["floquet-rigid_vertical"]),
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
        made_of=made_of("compare_normalisations"),
    shell:
        "job compare_normalisations {output} {input.published} {input.orthonormal} > {log} 2>&1"


rule judge_survival:
    # Needs the motions and grids of config/survival.yaml: `make survival` computes them and runs this.
    input:
        cases="results/survival/cases.nc",
        grids=[f"results/{name}/{name}.nc" for name in SURVIVAL_GRIDS],
        png="results/survival_growth/figures/survival_growth.png",
    output:
        md="results/paper/survival.md",
        html=report(
            "results/paper/survival.html",
            caption="../report/survival.rst",
            category="Model sensitivity",
            labels={"page": "The paper's conclusions under four models"},
        ),
        png=report(
            "results/paper/survival_growth.png",
            caption="../report/survival.rst",
            category="Model sensitivity",
            labels={"page": "Growth rate over speed and preload under each"},
        ),
    log:
        "results/paper/logs/judge_survival.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        made_of=made_of("judge_survival"),
    shell:
        "(job judge_survival {output.md} {output.html} {input.cases} {input.grids}"
        " && cp {input.png} {output.png}) > {log} 2>&1"
