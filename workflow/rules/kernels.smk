# Kernels, compiled once, so that parallel jobs find them in the cache.


COMPILED = source_hash("engine")


def compiled(kinds):
    """Files that mark compiled kernels of these kinds."""
    return [f"results/compiled/{COMPILED}/{kind}.txt" for kind in kinds]


rule compile:
    # Named by the sources: with a fixed name, users of kernels would need `ancient`. Snakemake (9.27) does not look
    # beyond a job that is only an ancient input, so changed sources would compile again and compute nothing.
    input:
        # a cycle needs the kernels of the motion as well
        lambda wildcards: compiled(
            [wildcards.kind.replace("floquet", "simulate")]
            if wildcards.kind.startswith("floquet")
            else []
        ),
    output:
        f"results/compiled/{COMPILED}/{{kind}}.txt",
    log:
        f"results/compiled/{COMPILED}/{{kind}}.log",
    wildcard_constraints:
        kind="|".join(KINDS),
    priority: 1
    conda:
        "../envs/disc_model.yaml"
    message:
        "Compiling kernels, once: {wildcards.kind}, 10 to 20 s on an idle core. What depends on them waits."
    shell:
        "python -m disc_model compile {wildcards.kind} > {output} 2> {log}"
