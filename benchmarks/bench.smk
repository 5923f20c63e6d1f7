# Speed against accuracy, where methods fail, what answers cost: `snakemake bench`, not part of `all`.
# Needs the extra `bench` for heyoka and SUNDIALS; without it their lines are left out.
from benchmarks.methods import METHODS

BENCH = "results/bench"
BENCHMARKS = WORKFLOW.parent / "benchmarks"
MEASURED = [
    method
    for method in METHODS.values()
    if method.maps and (not method.requires or not (CONDA or method.absent()))
]
# Tables of each figure, which it writes as one.
BENCH_FIGURES = {
    "overview": [f"{BENCH}/work_precision.csv"],
    "answers": [
        f"{BENCH}/answers/{line}.csv"
        for line in ["cycle", *(method.name for method in MEASURED)]
    ],
    "failure_maps": [
        f"{BENCH}/failure_maps/{method.name}_{scene}.csv"
        for method in sorted(
            MEASURED, key=lambda method: "stick_slip" not in method.maps
        )
        for scene in method.maps
    ],
}


rule bench:
    input:
        collect(
            f"{BENCH}/figures/{{figure}}.{{suffix}}",
            figure=BENCH_FIGURES,
            suffix=["pdf", "png", "csv"],
        ),


# Timed jobs take the whole machine (Snakemake lowers the threads to the available cores).
rule measure:
    output:
        f"{BENCH}/{{part}}.csv",
    log:
        f"{BENCH}/logs/measure/{{part}}.log",
    wildcard_constraints:
        part="work_precision|(answers|failure_maps)/[A-Za-z0-9_-]+",
    conda:
        "../workflow/envs/disc_model.yaml"
    threads: 1024
    params:
        code=physics_hash() + code_of("benchmarks"),
        # such as: failure_maps RK4 stick_slip
        study=lambda w: " ".join(Path(w.part).parts)
        .replace("_st", " st")
        .replace("_se", " se"),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 job ../benchmarks/scripts/measure {output} {params.study} > {log} 2>&1"


rule draw_benchmark:
    input:
        lambda wildcards: BENCH_FIGURES[wildcards.figure],
    output:
        pdf=f"{BENCH}/figures/{{figure}}.pdf",
        png=f"{BENCH}/figures/{{figure}}.png",
        csv=f"{BENCH}/figures/{{figure}}.csv",
    log:
        f"{BENCH}/logs/draw_benchmark/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(BENCH_FIGURES),
    conda:
        "../workflow/envs/disc_model.yaml"
    params:
        code=physics_hash() + code_of("benchmarks"),
    shell:
        "job ../benchmarks/scripts/draw_benchmark {wildcards.figure} {output} {input} > {log} 2>&1"
