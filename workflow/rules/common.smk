# The study, checked before anything runs, and what all the rules share.
import hashlib
import json
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger
from snakemake.settings.types import DeploymentMethod
from snakemake.shell import shell

from disc_model.figures.paper.catalogue import (
    CATALOGUE,
    SECTIONS,
    STYLE,
    label,
    module_of,
)
from disc_model.data.provenance import source_hash
from disc_model.studies.files import StudyError, read_file
from disc_model.data.provenance import unrecorded, why_unknown
from disc_model.studies.schema import study_from_config

PAPER = Path("config/paper.yaml")
# A study named with --configfile replaces the paper's instead of being mixed with it.
if not workflow.configfiles:
    try:
        read_file(PAPER)  # says where it is no YAML, which Snakemake does not
    except StudyError as error:
        raise WorkflowError(str(error)) from None

    configfile: PAPER


try:
    STUDY = study_from_config(config, workflow.configfiles)
    # ASKED are those whose figures are wanted; others are there because a figure shows them as well.
    GRIDS, ASKED = STUDY.grids(
        [Path(), *(Path(file).parent for file in workflow.configfiles)]
    )
except StudyError as error:
    raise WorkflowError(str(error)) from None

RESULTS = f"results/{STUDY.name}"
SCRIPTS = Path(workflow.basedir, "workflow", "scripts")

# Jobs run with the interpreter that runs Snakemake, whether or not its environment is active; or with that of conda.
OWN = f'export PATH="{Path(sys.executable).parent}:$PATH"; '
CONDA = DeploymentMethod.CONDA in workflow.deployment_settings.deployment_method
shell.prefix("set -euo pipefail; " + ("" if CONDA else OWN))


wildcard_constraints:
    study="|".join(GRIDS) or "none",
    batch=r"[0-9a-f]{12}",
    key=r"[0-9a-f]{12}",
    plot=r"[A-Za-z][A-Za-z0-9_]*",
    case="|".join(STUDY.specs) or "none",


def sources_of(script, *modules, files=()):
    """Hash of all that a script imports, and of what it is told to use besides: modules and further files.

    Snakemake itself watches none of it in a shell command.
    """
    return source_hash(SCRIPTS / f"{script}.py", *modules, files=files)


def refuse_unrecorded(files):
    """Stop if there are results of which Snakemake has no record: it would take them for up to date, whatever they are."""
    mending = {"check", "--unlock", "--touch"} & set(sys.argv)
    if not getattr(workflow, "is_main_process", True) or mending:
        return
    if reason := why_unknown(workflow):
        logger.warning(
            "Snakemake's records of how files were made are not where they are looked for"
            f" ({reason}): that results without a record are taken for up to date goes unnoticed."
        )
        return
    if unknown := unrecorded(files):
        raise WorkflowError(
            f"{unknown[0]} and {len(unknown) - 1} more are there, but not Snakemake's record of how they were made"
            " (was .snakemake removed?), so nothing tells whether they are up to date."
            " `snakemake -j1 check` removes them; then run again."
        )


def case_file(case):
    return f"{RESULTS}/cases/{case}.nc"


def batch_file(study, batch):
    return f"results/{study}/batches/{batch}.nc"


def merged_file(study):
    return f"results/{study}/merged/{GRIDS[study].key}.nc"


def merge_plan(study):
    """What a merge needs to know beyond its files, as JSON."""
    plan = {
        "batches": sorted(study.batches),
        "grid": study.grid,
        "attrs": {"study": study.name, "title": study.title},
    }
    return json.dumps(plan, sort_keys=True, ensure_ascii=False)


# What files are made of, as hashes. Jobs that read the files are told, so that a file that was made anew is not
# overlooked if the clock has been set back since they last ran: by its time it would be the older one.
CASE_SOURCES = sources_of("simulate_case")
BATCH_SOURCES = sources_of("compute_batch")
LABELS = json.dumps(STUDY.labels, sort_keys=True, ensure_ascii=False)


def digest(*parts):
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:12]


def cases_made_of(cases):
    return digest(CASE_SOURCES, [STUDY.specs[case].canonical for case in cases])


def merged_cases_made_of():
    sources = sources_of("merge_cases")
    return digest(cases_made_of(sorted(STUDY.specs)), LABELS, sources)


def grid_made_of(study):
    sources = sources_of("merge_batches")
    return digest(BATCH_SOURCES, merge_plan(GRIDS[study]), sources)


def plot_made_of(study, name):
    plot = GRIDS[study].plots[name]
    shown = [grid_made_of(other) for _, other in sorted(plot.others.items())]
    sources = sources_of("draw_plot", plot.module, files=[STYLE])
    return digest(plot.model_dump_json(), grid_made_of(study), shown, sources)


def shown_by(wildcards):
    """Merged files of the further studies that a figure shows, by role."""
    plot = GRIDS[wildcards.study].plots[wildcards.plot]
    return {role: merged_file(name) for role, name in sorted(plot.others.items())}


def motion_file(study, key):
    return f"results/{study}/motions/{key}.nc"


def motions_of(study):
    """The one file of motions of a study, or none."""
    return [motion_file(study, key) for key in GRIDS[study].motions]


def explorer_pictures():
    """The report's figures, in its order."""
    for name in [*STUDY.figures, *STUDY.plots]:
        own = name in STUDY.plots
        yield {
            "heading": (
                "Figures of cases" if own else SECTIONS[CATALOGUE[name].section]
            ),
            "title": name if own else label(name),
            "caption": drawn_by(name)[3],
            "file": f"{RESULTS}/figures/{name}.png",
        }
    for name in ASKED:
        for plot in GRIDS[name].plots:
            yield {
                "heading": "Maps and curves",
                "title": f"{GRIDS[name].title or name}: {plot}",
                "caption": f"From the grid study {name}.",
                "file": f"results/{name}/figures/{plot}.png",
            }
