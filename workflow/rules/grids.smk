# Grid studies: their points in parts, named after their content, and one dataset for each study. A grid of one part is
# computed where it is merged.
part_file = "results/{}/batches/{}.nc".format
grid_file = "results/{0}/{0}.nc".format
JOBS = {name: study.jobs for name, study in GRIDS.items()}


rule compute_part:
    # Takes points that other parts of the same content have: a further value on an axis computes its own points.
    output:
        part_file("{study}", "{part}"),
    log:
        "results/{study}/logs/compute_part/{part}.log",
    conda:
        "../envs/disc_model.yaml"
    resources:
        runtime=30,
    params:
        points=lambda w: JOBS[w.study][w.part],
    shell:
        "job jobs part {output} <<< {params.points:q} > {log} 2>&1"


rule merge_grid:
    input:
        lambda w: [
            part_file(w.study, part)
            for part in JOBS[w.study]
            if len(JOBS[w.study]) > 1
        ],
    output:
        nc=grid_file("{study}"),
        failed="results/{study}/{study}.failed.txt",
        remarks="results/{study}/{study}.remarks.txt",
    log:
        "results/{study}/logs/merge_grid.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        folder=lambda w: f"results/{w.study}/batches",
        plan=lambda w: json.dumps(
            {
                "layout": GRIDS[w.study].layout,
                "jobs": JOBS[w.study],
                "attrs": GRIDS[w.study].attrs,
            }
        ),
    shell:
        "job jobs grid {output} {params.folder} <<< {params.plan:q} > {log} 2>&1"


PRODUCTS += collect(rules.merge_grid.output, study=ASKED)
