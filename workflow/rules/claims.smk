# The paper's claims against the computed results.


from disc_model.paper import SCANS

SCANNED = {name: grid_file(name) for name in SCANS if name in GRIDS}


rule check_claims:
    # Some claims need multipliers of the case's cycle.
    input:
        compiled(["floquet-rigid_vertical"]),
        cases=rules.merge_cases.output,
        scans=list(SCANNED.values()),
    output:
        csv=f"{RESULTS}/claims.csv",
        md=f"{RESULTS}/claims.md",
        html=report(
            f"{RESULTS}/claims.html",
            caption="../report/claims.rst",
            category="Claims of the paper",
            labels={"table": "All statements, with verdicts"},
        ),
    log:
        f"{RESULTS}/logs/check_claims.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        made_of=made_of(
            "check_claims", of=[cases_made_of(), *map(grid_made_of, SCANNED)]
        ),
    shell:
        "job check_claims {output} {input.cases} {input.scans} > {log} 2>&1"


# A study may lack the case and the window of Tables 1 and 2.
TABLES = [
    f"table{n}"
    for n in (1, 2)
    if STUDY.claims
    and "spectrum_a"
    in (dict(STUDY.specs["F13"].windows) if "F13" in STUDY.specs else {})
]


rule make_table:
    # Tables 1 and 2 of the paper.
    input:
        case_file("F13"),
    output:
        csv=f"{RESULTS}/tables/{{table}}.csv",
        md=f"{RESULTS}/tables/{{table}}.md",
        html=report(
            f"{RESULTS}/tables/{{table}}.html",
            caption="../report/table.rst",
            category="Tables of the paper",
            labels=lambda wildcards: {
                "table": wildcards.table.replace("table", "Table ")
            },
        ),
    log:
        f"{RESULTS}/logs/make_table/{{table}}.log",
    wildcard_constraints:
        table="table[12]",
    conda:
        "../envs/disc_model.yaml"
    params:
        made_of=lambda wildcards: made_of("make_table", of=case_made_of("F13")),
    shell:
        "job make_table {wildcards.table} {output} {input} > {log} 2>&1"
