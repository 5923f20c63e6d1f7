# The study, checked before anything runs, and what all the rules share.
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.shell import shell

from disc_model.figures.catalogue import CATALOGUE, STYLE, module_of
from disc_model.provenance import SIMULATION, source_hash
from disc_model.study import StudyError, study_from_config

# A study named with --configfile replaces the paper's instead of being mixed with it.
if not workflow.configfiles:

    configfile: "config/paper.yaml"


try:
    STUDY = study_from_config(config, workflow.configfiles)
except StudyError as error:
    raise WorkflowError(str(error)) from None

RESULTS = f"results/{STUDY.name}"
SCRIPTS = Path(workflow.basedir, "workflow", "scripts")

# Jobs run with the interpreter that runs Snakemake, whether or not its environment is active.
shell.prefix(f'set -euo pipefail; export PATH="{Path(sys.executable).parent}:$PATH"; ')


wildcard_constraints:
    case=r"[A-Za-z][A-Za-z0-9_]*",
    figure=r"fig[0-9]+",


def sources_of(script, *modules, files=()):
    """Hash of the script and modules that make a result; Snakemake itself watches neither in a shell command."""
    return source_hash(*modules, files=[SCRIPTS / script, *files])


def case_file(case):
    return f"{RESULTS}/cases/{case}.nc"
