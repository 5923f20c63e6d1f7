# What rules call: hashes of sources, and figures with their files.


def code_of(*parts):
    """Hash of the bytes of files and folders beside the workflow, by which a rule runs again after a change."""
    texts = []
    for path in (WORKFLOW.parent / part for part in parts):
        files = sorted(path.rglob("*.*")) if path.is_dir() else [path]
        texts += [x.read_text() for x in files if x.suffix in (".py", ".yaml")]
    return content_key("".join(texts))


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def plan_of(wildcards):
    """What a job needs to draw a figure, in JSON, which is ASCII: commands can hold it in any locale."""
    figure = figure_of(wildcards)
    part = figure.plot.kind.rpartition(".")[0]
    own = sorted((WORKFLOW / part).glob("figures*.py")) if part else []
    plan = {
        "plot": figure.plot.model_dump(mode="json"),
        "files": files_of(wildcards),
        "titles": dict(figure.titles),
        "caption": figure.caption,
        "code": figures_hash() + "".join(content_key(file.read_text()) for file in own),
    }
    return json.dumps(plan)


def all_products(wildcards):
    """What `all` makes, with what the root's Snakefile adds in a clone: verdicts on the paper's claims."""
    if STUDY.claims and not rules.has("check_claims"):
        raise WorkflowError(
            f"{STUDY.study}: claims are judged by the Snakefile of a clone of the repository, not by `disc-model study`"
        )
    return PRODUCTS
