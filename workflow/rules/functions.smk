# What rules call: names of files, what decides each result, and figures. Rules themselves are in files of their own.
case_file = f"results/{STUDY.name}/cases/{{}}.nc".format
batch_file = "results/{}/batches/{}.nc".format
grid_file = "results/{0}/{0}.nc".format
motion_file = "results/{}/motions/{}.nc".format

LABELS = json.dumps(STUDY.labels, sort_keys=True)
PAGE_TITLE = json.dumps(STUDY.title or STUDY.name)


@cache
def case_made_of(case):
    spec = STUDY.specs[case]
    chosen = ["mode_choice"] if spec.modes else []
    return made_of("simulate_case", *chosen, of=spec.canonical)


@cache
def cases_made_of():
    cases = map(case_made_of, sorted(STUDY.specs))
    return made_of("merge_cases", of=[PAGE_TITLE, LABELS, *cases])


def merge_plan(study):
    """Data of a merge beyond its files, as JSON."""
    grid = GRIDS[study]
    plan = {"batches": sorted(grid.batches), "grid": grid.grid, "attrs": grid.attrs}
    return json.dumps(plan, sort_keys=True)


@cache
def batch_made_of(study):
    return made_of("compute_batch", *GRIDS[study].sources)


@cache
def grid_made_of(study):
    return made_of("merge_batches", of=[merge_plan(study), batch_made_of(study)])


FIGURES = STUDY.entries(GRIDS)


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


# By these Snakemake sees that a result is out of date; a user's settings may leave it with the times of files alone.
SEEN_BY = {RerunTrigger.INPUT, RerunTrigger.MTIME, RerunTrigger.PARAMS}


def need(files):
    """Input of a rule, for an input function: only when that is called are the settings in force known."""
    if MAIN and not SEEN_BY <= {*workflow.rerun_triggers}:
        given = " ".join(sorted(x.name.lower() for x in workflow.rerun_triggers))
        raise WorkflowError(
            f"rerun-triggers={given}: must include input, mtime and params, because results that a change has made"
            " out of date would stay otherwise; leave it out of your command and of the profile of this folder"
        )
    return files


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def figure_made_of(entry):
    figure = FIGURES[entry]
    inputs_made_of = grid_made_of if isinstance(figure.plot, Plot) else case_made_of
    of = [figure.plot.model_dump_json(), *map(inputs_made_of, figure.inputs.values())]
    part, _, name = figure.plot.kind.rpartition(".")
    drawings = (
        [f"{part}.figures.{name}"] if part else []
    )  # found by its name, so not among the imports
    return made_of("draw_figure", *drawings, of=of)


def motions_of(study):
    """The one file of motions of a study, or none."""
    return [motion_file(study, key) for key in GRIDS[study].motions]


@cache
def motions_made_of(study):
    return made_of("compute_motions", *GRIDS[study].sources, of=[*GRIDS[study].motions])


def measured_of(part):
    """Hash of the sources of a part of the benchmark."""
    source = STUDIES[Path(part).parts[0]].partition(".")[0]
    return made_of("measure", "benchmarks.methods", f"benchmarks.{source}")


def check_owner(files, owner):
    """Raise WorkflowError if other study files of this name, listed by the file `owner`, have made the results."""
    former = owner.read_text(encoding="utf-8").splitlines() if owner.exists() else files
    # further files laid over the same ones are the same study in other detail
    differ = any(file != before for file, before in zip(files, former))
    if not differ or not all(Path(file).is_file() for file in former):
        return
    try:
        same = mapping(read_files(*former)).get("study") == STUDY.name
    except DiscModelError as error:
        raise WorkflowError(str(error)) from None
    if same:
        raise WorkflowError(
            f"study={STUDY.name!r}: is also the name of the study in {', '.join(former)}, whose results are in"
            f" {RESULTS} and would be overwritten; give one of them another name, or another folder with --directory"
        )


@cache
def unrecorded():
    """Results without a record of Snakemake, which would take them for up to date."""
    store = workflow.persistence
    if any(Path(store.path, "incomplete").rglob("*")):
        return []  # an interrupted run comes first: Snakemake knows of it
    files = [*map(case_file, STUDY.specs), *PRODUCTS]
    return [x for x in files if Path(x).exists() and not store.metadata(IOFile(x))]


def refuse_unrecorded(wildcards):
    """Stop if there are `unrecorded` results: an input function is called when Snakemake has read its records."""
    if MAIN and "--touch" not in sys.argv and (unknown := unrecorded()):
        raise WorkflowError(
            f"{unknown[0]} and {len(unknown) - 1} more are there, but not Snakemake's record of how they were made"
            " (was .snakemake removed?), so nothing tells whether they are up to date."
            " If results/ was copied from another folder, copy that folder's .snakemake beside it as well."
            " Else `snakemake -j1 check` removes them (or `disc-model study --target check`); then run again."
        )
    return need([])
