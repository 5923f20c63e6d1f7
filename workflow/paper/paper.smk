# The paper's claims and tables against the computed results, with the modes normalised otherwise, and under other models.


from workflow.paper import JUDGING_TABLES, SCANS, SURVIVAL_GRIDS, TABLE_CASES

SCANNED = {name: grid_file(name) for name in SCANS if name in GRIDS}
# A change of the ledger judges again; what results are is seen by their files.
PAPER_CODE = code_of("workflow/paper", "src/disc_model/data")
MADE = [table for table, cases in TABLE_CASES.items() if STUDY.cases.keys() >= {*cases}]


rule check_claims:
    input:
        cases=lambda w: sorted(map(case_file, STUDY.cases)),
        scans=list(SCANNED.values()),
        tables=[
            f"{RESULTS}/tables/{table}.csv"
            for table in JUDGING_TABLES
            if table in MADE
        ],
    output:
        csv=f"{RESULTS}/claims.csv",
        md=f"{RESULTS}/claims.md",
        html=report(
            f"{RESULTS}/claims.html",
            caption="report/claims.rst",
            category="Claims of the paper",
            labels={"table": "All statements, with verdicts"},
        ),
    log:
        f"{RESULTS}/logs/check_claims.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        code=PAPER_CODE,
    shell:
        "job paper/scripts/check_claims {output} {input.cases} {input.scans} {input.tables} > {log} 2>&1"


rule make_table:
    # Tables 1 and 2 of the paper, and those on which results rest: each from its own cases, if the study has them.
    input:
        lambda w: [*map(case_file, TABLE_CASES[w.table])],
    output:
        csv=f"{RESULTS}/tables/{{table}}.csv",
        md=f"{RESULTS}/tables/{{table}}.md",
        html=report(
            f"{RESULTS}/tables/{{table}}.html",
            caption="report/table.rst",
            category="Tables of the paper",
            labels=lambda w: {"table": w.table.replace("table", "Table ")},
        ),
    log:
        f"{RESULTS}/logs/make_table/{{table}}.log",
    wildcard_constraints:
        table="|".join(TABLE_CASES),
    conda:
        "../envs/disc_model.yaml"
    params:
        # what a table has not from cases, as that of the precursor, it computes
        code=PAPER_CODE + physics_hash(),
    shell:
        "job paper/scripts/make_table {wildcards.table} {output} {input} > {log} 2>&1"


rule show_model:
    # A drawing that was made once, with the radii of Table 1.
    input:
        # relative, so that a folder that moves stays up to date
        os.path.relpath(WORKFLOW / "paper" / "figures_model.svg"),
    output:
        report(
            f"{RESULTS}/figures/model.svg",
            caption="report/model.rst",
            category="Figures",
            subcategory="2 The model",
            labels={"figure": "Fig.  1: The model"},
        ),
    log:
        f"{RESULTS}/logs/show_model.log",
    conda:
        "../envs/disc_model.yaml"
    shell:
        "cp {input:q} {output:q} > {log} 2>&1"


rule compare_normalisations:
    # Needs the paper's cases under both normalisations.
    input:
        published=collect("results/paper/cases/{x}.nc", x=STUDY.cases),
        orthonormal=collect("results/paper_orthonormal/cases/{x}.nc", x=STUDY.cases),
    output:
        csv="results/paper/normalisation.csv",
        md="results/paper/normalisation.md",
        html=report(
            "results/paper/normalisation.html",
            caption="report/normalisation.rst",
            category="Normalisation of the modes",
            labels={"page": "What changes with Eq. (17)"},
        ),
    log:
        "results/paper/logs/compare_normalisations.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        code=PAPER_CODE,
    shell:
        "job paper/scripts/compare_normalisations {output} {input.published} {input.orthonormal} > {log} 2>&1"


rule judge_survival:
    # For `--configfile config/survival.yaml`, whose motions and grids it needs.
    input:
        cases=collect("results/survival/cases/{x}.nc", x=STUDY.cases),
        grids=[f"results/{name}/{name}.nc" for name in SURVIVAL_GRIDS],
        png="results/survival_growth/figures/survival_growth.png",
    output:
        csv="results/paper/survival.csv",
        md="results/paper/survival.md",
        html=report(
            "results/paper/survival.html",
            caption="report/survival.rst",
            category="Model sensitivity",
            labels={"page": "The paper's conclusions under seven models"},
        ),
        png=report(
            "results/paper/survival_growth.png",
            caption="report/survival.rst",
            category="Model sensitivity",
            labels={"page": "Growth rate over speed and preload under each"},
        ),
    log:
        "results/paper/logs/judge_survival.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        code=PAPER_CODE,
    shell:
        "(job paper/scripts/judge_survival {output.csv} {output.md} {output.html} {input.cases} {input.grids}"
        " && cp {input.png} {output.png}) > {log} 2>&1"


if STUDY.claims:
    PRODUCTS += [*rules.check_claims.output, *rules.show_model.output]
    PRODUCTS += collect(rules.make_table.output, table=MADE)
