# What the paper says against what came out.


rule check_claims:
    input:
        rules.merge_cases.output,
    output:
        csv=f"{RESULTS}/claims.csv",
        md=f"{RESULTS}/claims.md",
    log:
        f"{RESULTS}/logs/check_claims.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        sources=sources_of("check_claims.py", "disc_model.claims"),
    shell:
        "python workflow/scripts/check_claims.py {input} --csv {output.csv} --md {output.md} > {log} 2>&1"
