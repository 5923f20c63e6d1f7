# Speed against accuracy, where methods fail, how many modes are needed: `snakemake bench`, not part of `all`.
# Needs the extra `bench` for heyoka and SUNDIALS; without it their lines are left out.
from benchmarks.methods import METHODS

BENCH = "results/bench"
BENCHMARKS = WORKFLOW.parent / "benchmarks"
MEASURED = [
    method
    for method in METHODS.values()
    if method.maps and (not method.requires or not (CONDA or method.absent()))
]
QUESTIONED = [method.name for method in MEASURED]
FAILURE_MAPS = [
    f"{method.name}_{scene}"
    for method in sorted(MEASURED, key=lambda method: "stick_slip" not in method.maps)
    for scene in method.maps
]
# Module and function of each study; a change of one measures only what it is part of.
STUDIES = {
    "work_precision": "work_precision.work_precision",
    "contact_truncation": "truncation.contact_study",
    "answers": "answers.answers",
    "answer_maps": "answer_maps.answer_map",
    "failure_maps": "failure_maps.failure_map",
    "scaling": "scaling.scaling",
    "shares": "shares.shares",
}
BENCH_FIGURES = {
    "overview": f"{BENCH}/work_precision.nc",
    "failure_maps": collect(f"{BENCH}/failure_maps/{{map}}.nc", map=FAILURE_MAPS),
    "contact_truncation": f"{BENCH}/contact_truncation.nc",
    "scaling": f"{BENCH}/scaling.nc",
    "answers": f"{BENCH}/answers.nc",
    "prices": f"{BENCH}/answers.nc",
    "answer_maps": collect(f"{BENCH}/answer_maps/{{method}}.nc", method=QUESTIONED),
}


rule bench:
    input:
        f"{BENCH}/work_precision.csv",
        f"{BENCH}/work_precision_avx2.csv",
        f"{BENCH}/answers.csv",
        f"{BENCH}/shares.nc",
        collect(
            f"{BENCH}/figures/{{figure}}.{{suffix}}",
            figure=BENCH_FIGURES,
            suffix=["pdf", "png"],
        ),


# Timed jobs take the whole machine (Snakemake lowers the threads to the available cores).
# heyoka has no option for the target processor: in the run for AVX2 it stays native.
rule measure:
    output:
        f"{BENCH}/{{part}}{{target}}.nc",
    log:
        f"{BENCH}/logs/measure/{{part}}{{target}}.log",
    wildcard_constraints:
        part="work_precision|contact_truncation|scaling|shares|(answers|answer_maps|failure_maps)/[A-Za-z0-9_-]+",
    conda:
        "../workflow/envs/disc_model.yaml"
    threads: 1024
    params:
        code=physics_hash() + code_of("benchmarks"),
        study=lambda w: STUDIES[Path(w.part).parts[0]],
        of=lambda w: " ".join(Path(w.part).parts[1:]).replace("_", " ", 1),
        compiled=lambda w: (
            "NUMBA_CPU_NAME=x86-64-v3 NUMBA_CPU_FEATURES=" if w.target else ""
        ),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 {params.compiled} job ../benchmarks/scripts/measure {params.study} {output} {params.of} > {log} 2>&1"


rule tabulate_work_precision:
    input:
        f"{BENCH}/work_precision{{target}}.nc",
    output:
        f"{BENCH}/work_precision{{target}}.csv",
    log:
        f"{BENCH}/logs/tabulate_work_precision{{target}}.log",
    conda:
        "../workflow/envs/disc_model.yaml"
    params:
        code=physics_hash() + code_of("benchmarks"),
    shell:
        "job ../benchmarks/scripts/tabulate_work_precision {output} {input} > {log} 2>&1"


rule merge_answers:
    input:
        collect(f"{BENCH}/answers/{{part}}.nc", part=[*QUESTIONED, "cycle", "models"]),
    output:
        nc=f"{BENCH}/answers.nc",
        csv=f"{BENCH}/answers.csv",
    log:
        f"{BENCH}/logs/merge_answers.log",
    conda:
        "../workflow/envs/disc_model.yaml"
    params:
        code=physics_hash() + code_of("benchmarks"),
    shell:
        "job ../benchmarks/scripts/merge_answers {output} {input} > {log} 2>&1"


rule draw_benchmark:
    input:
        lambda wildcards: BENCH_FIGURES[wildcards.figure],
    output:
        pdf=f"{BENCH}/figures/{{figure}}.pdf",
        png=f"{BENCH}/figures/{{figure}}.png",
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
