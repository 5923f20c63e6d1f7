# What the paper says against what came out.


from disc_model.claims import SCANS

# What claims and their pages say is data beside the checks; what each case has to be is the paper's study.
CLAIM_TEXTS = [
    *sorted((PACKAGE / "claims").glob("*.yaml")),
    PACKAGE / "claims" / "page.html",
    PACKAGE / "config" / "paper.yaml",
]
SCANNED = {name: merged_file(name) for name in SCANS if name in GRIDS}


rule check_claims:
    # Some claims ask for multipliers of the case's cycle.
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
        made_of=digest(merged_cases_made_of(), [grid_made_of(name) for name in SCANNED]),
        scans=[f"--scan {name}={file}" for name, file in SCANNED.items()],
        sources=sources_of("check_claims", files=CLAIM_TEXTS),
    shell:
        "python workflow/scripts/check_claims.py {input.cases} {params.scans}"
        " --csv {output.csv} --md {output.md} --html {output.html} > {log} 2>&1"


# The case and the window that Tables 1 and 2 are made of may be missing from a study.
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
        made_of=lambda wildcards: cases_made_of(["F13"]),
        sources=sources_of("make_table", files=CLAIM_TEXTS),
    shell:
        "python workflow/scripts/make_table.py {wildcards.table} {input}"
        " --csv {output.csv} --md {output.md} --html {output.html} > {log} 2>&1"
