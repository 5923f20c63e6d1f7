# Treatment of results that are out of date, damaged, or of unknown origin: run by name, not part of `all`.


@cache
def unrecorded():
    """Results without a record of Snakemake, which would take them for up to date."""
    store = workflow.persistence
    if any(Path(store.path, "incomplete").rglob("*")):
        return []  # an interrupted run comes first: Snakemake knows of it
    files = [*map(case_file, STUDY.specs), *PRODUCTS]
    return [x for x in files if Path(x).exists() and not store.metadata(IOFile(x))]


def refuse_unrecorded(wildcards):
    """Stop if there are `unrecorded` results; an input function, since Snakemake has read its records by then."""
    main = getattr(workflow, "is_main_process", True) and "--touch" not in sys.argv
    if main and (unknown := unrecorded()):
        raise WorkflowError(
            f"{unknown[0]} and {len(unknown) - 1} more are there, but not Snakemake's record of how they were made"
            " (was .snakemake removed?), so nothing tells whether they are up to date."
            " If results/ was copied from another folder, copy that folder's .snakemake beside it as well."
            " Else `snakemake -j1 check` removes them (or `disc-model study --target check`); then run again."
        )
    return []


rule gc:
    # Removes files that no study refers to any more: batches and merged files of former values, options or sources.
    log:
        "results/gc.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    params:
        kept=json.dumps(
            {
                name: [*study.batches, *study.motions]
                for name, study in sorted(GRIDS.items())
            }
        ),
    shell:
        "job gc <<< {params.kept:q} 2>&1 | tee {log}"


rule check:
    # Removes files that cannot be read or have no record, so that they are computed again.
    log:
        "results/check.log",
    localrule: True
    conda:
        "../envs/disc_model.yaml"
    params:
        unrecorded=lambda wildcards: json.dumps(unrecorded()),
    shell:
        "job check <<< {params.unrecorded:q} 2>&1 | tee {log}"
