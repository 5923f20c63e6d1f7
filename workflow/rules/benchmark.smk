# Speed against accuracy, where methods fail, how many modes are needed: `snakemake bench`, not part of `all`.
# Needs the extra `bench` for heyoka and SUNDIALS; without it their lines are left out.
from disc_model.benchmarks.register import RIVALS, SCENES

BENCH = "results/bench"
FAILURE_MAPS = [
    f"{rival.name}_{scene}"
    for rival in sorted(RIVALS, key=lambda rival: "stick_slip" not in rival.maps)
    for scene in rival.maps
    if not rival.requires or not (CONDA or rival.missing())
]
QUESTIONED = [
    rival.name
    for rival in RIVALS
    if rival.maps and (not rival.requires or not (CONDA or rival.missing()))
]
BENCH_FIGURES = [
    "overview",
    *(f"work_precision_{scene}" for scene in SCENES),
    "failure_maps",
    "truncation",
    "contact_truncation",
    "answers",
    "prices",
    "answer_maps",
]
BENCH_INPUTS = {
    "answers": f"{BENCH}/answers.nc",
    "prices": f"{BENCH}/answers.nc",
    "answer_maps": collect(f"{BENCH}/answer_maps/{{method}}.nc", method=QUESTIONED),
    "truncation": f"{BENCH}/truncation.nc",
    "contact_truncation": f"{BENCH}/contact_truncation.nc",
    "failure_maps": collect(f"{BENCH}/failure_maps/{{map}}.nc", map=FAILURE_MAPS),
}
# Methods are loaded by the names that the register gives, which following imports does not see.
METHODS = sorted(
    {
        f"disc_model.benchmarks.methods.{rival.place.partition(':')[0]}"
        for rival in RIVALS
    }
)
BENCH_DATA = [
    PACKAGE / "benchmarks" / "data" / name
    for name in ("benchmark_reference.json", "separating_start.json", "answers.json")
]

BENCH_TEXTS = [PACKAGE / "benchmarks" / "texts.yaml"]


rule bench:
    input:
        f"{BENCH}/table.md",
        f"{BENCH}/table.csv",
        f"{BENCH}/answers.md",
        f"{BENCH}/contact_truncation.md",
        collect(
            f"{BENCH}/figures/{{figure}}.{{suffix}}",
            figure=BENCH_FIGURES,
            suffix=["pdf", "png"],
        ),


# What looks at the clock takes the whole machine (Snakemake lowers the threads to the cores there are).
rule measure_work_precision:
    output:
        nc=f"{BENCH}/work_precision.nc",
        csv=f"{BENCH}/table.csv",
        md=f"{BENCH}/table.md",
    log:
        f"{BENCH}/logs/measure_work_precision.log",
    conda:
        "../envs/disc_model.yaml"
    threads: 1024
    params:
        sources=sources_of("measure_work_precision", *METHODS, files=BENCH_DATA),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python workflow/scripts/measure_work_precision.py {output.nc}"
        " --csv {output.csv} --md {output.md} > {log} 2>&1"


rule measure_answers:
    output:
        f"{BENCH}/answers/{{part}}.nc",
    log:
        f"{BENCH}/logs/measure_answers/{{part}}.log",
    wildcard_constraints:
        part="[A-Za-z0-9-]+",
    conda:
        "../envs/disc_model.yaml"
    threads: 1024
    params:
        sources=sources_of("measure_answers", *METHODS, files=BENCH_DATA),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python workflow/scripts/measure_answers.py {wildcards.part} {output}"
        " > {log} 2>&1"


rule merge_answers:
    input:
        collect(f"{BENCH}/answers/{{part}}.nc", part=[*QUESTIONED, "cycle", "models"]),
    output:
        nc=f"{BENCH}/answers.nc",
        md=f"{BENCH}/answers.md",
    log:
        f"{BENCH}/logs/merge_answers.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        sources=sources_of("merge_answers", files=BENCH_DATA + BENCH_TEXTS),
    shell:
        "python workflow/scripts/merge_answers.py {input} --out {output.nc} --md {output.md} > {log} 2>&1"


rule map_failures:
    output:
        f"{BENCH}/failure_maps/{{method}}_{{scene}}.nc",
    log:
        f"{BENCH}/logs/map_failures/{{method}}_{{scene}}.log",
    wildcard_constraints:
        method="[A-Za-z0-9-]+",
        scene="stick_slip|separating",
    conda:
        "../envs/disc_model.yaml"
    threads: 1024
    params:
        sources=sources_of("map_failures", *METHODS, files=BENCH_DATA),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python workflow/scripts/map_failures.py {wildcards.method}"
        " {wildcards.scene} {output} > {log} 2>&1"


rule map_answers:
    output:
        f"{BENCH}/answer_maps/{{method}}.nc",
    log:
        f"{BENCH}/logs/map_answers/{{method}}.log",
    wildcard_constraints:
        method="[A-Za-z0-9-]+",
    conda:
        "../envs/disc_model.yaml"
    threads: 1024
    params:
        sources=sources_of("map_answers", *METHODS, files=BENCH_DATA),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python workflow/scripts/map_answers.py {wildcards.method} {output}"
        " > {log} 2>&1"


rule study_truncation:
    output:
        f"{BENCH}/{{truncation}}.nc",
    log:
        f"{BENCH}/logs/study_{{truncation}}.log",
    wildcard_constraints:
        truncation="truncation|contact_truncation",
    conda:
        "../envs/disc_model.yaml"
    threads: 1024
    params:
        sources=sources_of("study_truncation", *METHODS),
    shell:
        "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python workflow/scripts/study_truncation.py"
        " {wildcards.truncation} {output} > {log} 2>&1"


rule tell_truncation:
    input:
        f"{BENCH}/contact_truncation.nc",
    output:
        f"{BENCH}/contact_truncation.md",
    log:
        f"{BENCH}/logs/tell_truncation.log",
    conda:
        "../envs/disc_model.yaml"
    params:
        sources=sources_of("tell_truncation", files=BENCH_TEXTS),
    shell:
        "python workflow/scripts/tell_truncation.py {input} {output} > {log} 2>&1"


rule draw_benchmark:
    input:
        lambda wildcards: BENCH_INPUTS.get(
            wildcards.figure, f"{BENCH}/work_precision.nc"
        ),
    output:
        pdf=f"{BENCH}/figures/{{figure}}.pdf",
        png=f"{BENCH}/figures/{{figure}}.png",
    log:
        f"{BENCH}/logs/draw_benchmark/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(BENCH_FIGURES),
    conda:
        "../envs/disc_model.yaml"
    params:
        plot=lambda wildcards: OwnFigure(
            by="benchmark.draw", options={"figure": wildcards.figure}
        ).model_dump_json(),
        sources=sources_of("draw_figure", "disc_model.figures.benchmark", files=[STYLE]),
        files=lambda wildcards, input: [f"{Path(file).stem}={file}" for file in input],
    shell:
        "python workflow/scripts/draw_figure.py {params.plot:q} {params.files:q} --out {output.pdf} --out {output.png}"
        " > {log} 2>&1"
