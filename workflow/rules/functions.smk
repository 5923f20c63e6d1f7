# What rules call: names of files, figures and their data, and checks before a run.
case_file = f"results/{STUDY.name}/cases/{{}}.nc".format
batch_file = "results/{}/batches/{}.nc".format
grid_file = "results/{0}/{0}.nc".format
motion_file = "results/{}/motions/{}.nc".format

LABELS = json.dumps(STUDY.labels, sort_keys=True)
PAGE_TITLE = json.dumps(STUDY.title or STUDY.name)
FIGURES = STUDY.entries(GRIDS)


def own_file(study):
    """File of the quantity of a grid study."""
    return quantity_file(GRIDS[study].quantity)


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def drawing_of(wildcards):
    """Sources of a figure: those of the package, and those of the part that its kind belongs to."""
    part = figure_of(wildcards).plot.kind.rpartition(".")[0]
    own = sorted((WORKFLOW / part).glob("figures*")) if part else []
    return ["figures", "data", *own]


def motions_of(study):
    """The one file of motions of a study, or none."""
    return [motion_file(study, key) for key in GRIDS[study].motions]


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


def stated_of(grid):
    """What a study's file says of its page: units of figures, dimensions across and up in the first map, and what stored
    motions are.
    """
    units = {}
    for plot in reversed(grid.plots.values()):
        units.update(plot.units)
    maps = [
        [plot.x, plot.y]
        for plot in grid.plots.values()
        if {"x", "y"} <= plot.axes.keys()
    ]
    return {
        "units": units,
        "axes": next(iter(maps), []),
        "motion": grid.options.motion,
        "motion_by": dict(grid.options.motion_by),
    }


def all_products():
    """What `all` makes, with what the root's Snakefile adds in a clone: verdicts on the paper's claims."""
    if STUDY.claims and not hasattr(rules, "check_claims"):
        raise WorkflowError(
            f"{STUDY.name}: claims are judged by the Snakefile of a clone of the repository, not by `disc-model study`"
        )
    return PRODUCTS


def page_file(wildcards):
    """The page, if there is what writes it."""
    missing = [name for name in ("altair", "vl_convert") if find_spec(name) is None]
    if missing and not CONDA:
        raise WorkflowError(
            f"There is no module {missing[0]}: `pip install 'disc_model[explorer]'` brings what the page needs."
        )
    return need([f"{RESULTS}/explorer.html"])
