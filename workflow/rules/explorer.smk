# A page that shows every point of grid studies, and motions: `snakemake explorer`, not part of `all`.
from itertools import chain

# Studies of a whole plane come first.
PLANES = ("outcome", "regions")
EXPLORED = sorted(GRIDS, key=lambda study: GRIDS[study].quantity not in PLANES)
EXPLORER = json.dumps(
    {
        "title": STUDY.title or STUDY.name,
        "studies": [
            {
                "name": study,
                "data": grid_file(study),
                "motions": next(iter(motions_of(study)), ""),
                "stated": stated_of(GRIDS[study]),
            }
            for study in EXPLORED
        ],
    }
)


rule explorer:
    input:
        page_file,


rule compute_motions:
    # Short histories at a few points of a study's grid. As with batches, the file's name is the hash of all that
    # decides its content.
    output:
        motion_file("{study}", "{key}"),
    log:
        "results/{study}/logs/compute_motions/{key}.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        batch=lambda wildcards: GRIDS[wildcards.study].motions[wildcards.key],
        code=lambda wildcards: code_of(
            "compute_motions",
            *BATCHES,
            "studies/motions.py",
            own_file(wildcards.study),
        ),
    shell:
        "job compute_motions {output} <<< {params.batch:q} > {log} 2>&1"


rule build_explorer:
    input:
        studies=[grid_file(study) for study in EXPLORED],
        motions=chain.from_iterable(map(motions_of, EXPLORED)),
    output:
        f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/build_explorer.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        plan=lambda wildcards: EXPLORER,  # a function: braces in a title are no wildcards
        code=code_of("build_explorer", "explorer", "figures", "data"),
    shell:
        "job build_explorer {output} <<< {params.plan:q} > {log} 2>&1"
