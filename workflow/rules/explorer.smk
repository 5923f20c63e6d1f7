# A page that shows every point of grid studies, and motions: `snakemake explorer`, not part of `all`.

# Studies of a whole plane come first.
EXPLORED = sorted(
    GRIDS, key=lambda study: GRIDS[study].quantity not in ("outcome", "regions")
)
MOTIONS = {name: GRIDS[name].motions for name in GRIDS}
motion_files = {
    name: [f"results/{name}/motions/{key}.nc" for key in jobs]
    for name, jobs in MOTIONS.items()
}


rule explorer:
    input:
        f"{RESULTS}/explorer.html",


rule compute_motions:
    output:
        "results/{study}/motions/{part}.nc",
    log:
        "results/{study}/logs/compute_motions/{part}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        points=lambda w: MOTIONS[w.study][w.part],
    shell:
        "job jobs motions {output} <<< {params.points:q} > {log} 2>&1"


rule build_explorer:
    input:
        studies=[grid_file(study) for study in EXPLORED],
        motions=sum([motion_files[study] for study in EXPLORED], []),
    output:
        f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/build_explorer.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        # a function: braces in a title are no wildcards
        plan=lambda w: json.dumps(
            {
                "title": STUDY.title or STUDY.study,
                "code": figures_hash(),
                "studies": [
                    {
                        "name": study,
                        "data": grid_file(study),
                        "motions": "".join(motion_files[study]),
                        "stated": GRIDS[study].page,
                    }
                    for study in EXPLORED
                ],
            }
        ),
    shell:
        "job jobs explorer {output} <<< {params.plan:q} > {log} 2>&1"
