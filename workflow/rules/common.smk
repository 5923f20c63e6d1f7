# The study, checked before anything runs, and common parts of all rules.
import hashlib
import json
import os
import shlex
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.io import IOFile
from snakemake.logging import logger
from snakemake.settings.types import DeploymentMethod
from snakemake.shell import shell

CONDA = DeploymentMethod.CONDA in workflow.deployment_settings.deployment_method

# The package lies beside the workflow in a clone, and contains it where it is installed.
WORKFLOW = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parent
SOURCES = (WORKFLOW.parent / "src").resolve()
if find_spec("disc_model") is None and (SOURCES / "disc_model").is_dir():
    sys.path.insert(0, str(SOURCES))
try:
    from disc_model.figures.kind import Plot
    from disc_model.kernels import KINDS, kinds_of_case
    from disc_model.errors import DiscModelError
    from disc_model.sources import source_hash
    from disc_model.studies.checks import check_owner, check_targets, closing_lines
    from disc_model.studies.study import read_file, study_from_config
except ModuleNotFoundError as error:
    raise WorkflowError(
        f"There is no module {error.name}: install the package disc_model with what it needs"
        " (`make env` in a clone of its repository), and use that environment's snakemake."
    ) from None

# Imports of the jobs, so that a dry run does not succeed where they would fail.
if missing := [
    name
    for name in ("numba", "netCDF4", "matplotlib", "cmcrameri")
    if not CONDA and find_spec(name) is None
]:
    raise WorkflowError(
        f"There is no module {', '.join(missing)}: `pip install 'disc_model[workflow]'` brings all that jobs need."
    )

# A study named with --configfile replaces the paper's instead of being mixed with it.
PAPER = Path("config/paper.yaml")
if not PAPER.exists():
    PAPER = WORKFLOW.parent / PAPER
if not workflow.configfiles and "study" not in config:
    try:
        read_file(PAPER)  # reports the place of faulty YAML, which Snakemake does not
    except DiscModelError as error:
        raise WorkflowError(str(error)) from None

    configfile: PAPER


try:
    STUDY = study_from_config(config, workflow.configfiles)
    # ASKED are the grids whose figures are requested; a figure may show further ones.
    GRIDS, ASKED = STUDY.grids(
        [
            Path(),
            *(Path(file).parent for file in workflow.configfiles),
            WORKFLOW.parent,
        ]
    )
except DiscModelError as error:
    raise WorkflowError(str(error)) from None

if getattr(workflow, "is_main_process", True):
    for checked in [STUDY, *(GRIDS[name] for name in ASKED)]:
        for doubt in checked.doubts:
            logger.warning(f"{checked.name}: warning: {doubt}")

RESULTS = f"results/{STUDY.name}"
SCRIPTS = str(WORKFLOW / "scripts")

if CONDA and not SOURCES.is_dir():
    raise WorkflowError(
        "With conda the workflow is run from a clone of its repository, where the package's sources are."
    )


def put_first(variable, folder):
    """Let jobs search a folder before the others of a variable of the environment."""
    os.environ[variable] = os.pathsep.join(
        filter(None, [str(folder), os.environ.get(variable)])
    )


# Jobs use the interpreter of Snakemake, whether or not its environment is active, or that of conda.
if not CONDA:
    put_first("PATH", Path(sys.executable).parent)
if CONDA or str(SOURCES) in sys.path:
    put_first("PYTHONPATH", SOURCES)
os.environ["PYTHONUTF8"] = "1"  # in any locale
# Commands leave out the folder of the scripts: Snakemake runs a job again if its command changes.
PREFIX = f'set -euo pipefail; job() {{ python {shlex.quote(SCRIPTS)}/"$1.py" "${{@:2}}"; }}; '
shell.prefix(PREFIX.replace("{", "{{").replace("}", "}}"))


wildcard_constraints:
    study="|".join(GRIDS) or "none",
    batch=r"[0-9a-f]{12}",
    key=r"[0-9a-f]{12}",
    case="|".join(STUDY.specs) or "none",


def made_of(rule, *sources, of=()):
    """Hash of everything that decides a result: sources of its script and others, arguments, and origin of its inputs.

    It is a parameter of each rule, by which Snakemake runs again what has changed. By itself Snakemake would overlook
    sources, and inputs that were made anew after the clock had been set back.
    """
    hashed = source_hash(Path(SCRIPTS, f"{rule}.py"), *sources)
    return hashlib.sha256(json.dumps([hashed, of]).encode()).hexdigest()[:12]


def figure_names():
    """Names of figures, by the study in whose folder they are."""
    figures = {name: [] for name in (STUDY.name, *GRIDS)}
    for study, name in FIGURES:
        figures[study].append(name)
    return figures


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


def case_file(case):
    return f"{RESULTS}/cases/{case}.nc"


def batch_file(study, batch):
    return f"results/{study}/batches/{batch}.nc"


def grid_file(study):
    return f"results/{study}/{study}.nc"


def compiled(kinds):
    """Files that mark compiled kernels of these kinds."""
    return [f"results/compiled/{COMPILED}/{kind}.txt" for kind in kinds]


COMPILED = source_hash("engine")


def merge_plan(study):
    """Data of a merge beyond its files, as JSON."""
    plan = {
        "batches": sorted(GRIDS[study].batches),
        "grid": GRIDS[study].grid,
        "attrs": GRIDS[study].attrs,
    }
    return json.dumps(plan, sort_keys=True)


LABELS = json.dumps(STUDY.labels, sort_keys=True)


def case_made_of(case):
    spec = STUDY.specs[case]
    chosen = ["mode_choice"] if spec.modes else []
    return made_of("simulate_case", *chosen, of=spec.canonical)


def cases_made_of():
    return made_of("merge_cases", of=[LABELS, *map(case_made_of, sorted(STUDY.specs))])


def batch_made_of(study):
    return made_of("compute_batch", *GRIDS[study].sources)


def grid_made_of(study):
    return made_of("merge_batches", of=[merge_plan(study), batch_made_of(study)])


FIGURES = STUDY.entries(GRIDS)


def figure_of(wildcards):
    return FIGURES[wildcards.study, wildcards.figure]


def files_of(wildcards):
    """Files from which a figure is drawn, by the names of its cases, or by the roles of its grids."""
    figure = figure_of(wildcards)
    file = grid_file if isinstance(figure.plot, Plot) else case_file
    return {role: file(name) for role, name in figure.inputs.items()}


def figure_made_of(wildcards):
    figure = figure_of(wildcards)
    inputs_made_of = grid_made_of if isinstance(figure.plot, Plot) else case_made_of
    of = [figure.plot.model_dump_json(), *map(inputs_made_of, figure.inputs.values())]
    return made_of("draw_figure", figure.plot.module, of=of)


def motion_file(study, key):
    return f"results/{study}/motions/{key}.nc"


def motions_of(study):
    """The one file of motions of a study, or none."""
    return [motion_file(study, key) for key in GRIDS[study].motions]


def explorer_pictures():
    """The report's figures, in its order."""
    for (study, name), figure in FIGURES.items():
        if study in (STUDY.name, *ASKED):
            yield {
                "heading": figure.section or figure.category,
                "title": figure.title,
                "caption": figure.caption,
                "file": f"results/{study}/figures/{name}.png",
            }
