# The study, checked before anything runs, and common parts of all rules.
import json
import os
import re
import shlex
import sys
from importlib.util import find_spec
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from tempfile import TemporaryDirectory
from weakref import finalize

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger
from snakemake.settings.types import DeploymentMethod, RerunTrigger
from snakemake.shell import shell

CONDA = DeploymentMethod.CONDA in workflow.deployment_settings.deployment_method

# The package lies beside the workflow in a clone, and contains it where it is installed.
WORKFLOW = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parent
SOURCES = (WORKFLOW.parent / "src").resolve()
if find_spec("disc_model") is None and (SOURCES / "disc_model").is_dir():
    sys.path.insert(0, str(SOURCES))


# Jobs use the interpreter of Snakemake, whatever its name and whether or not its environment is active, or that of conda.
INTERPRETER = "python" if CONDA else sys.executable
if CONDA or str(SOURCES) in sys.path:
    folders = filter(None, [str(SOURCES), os.environ.get("PYTHONPATH")])
    os.environ.update(PYTHONPATH=os.pathsep.join(folders))
# In any locale; and jobs only write files, whatever a notebook from which they are started has chosen.
os.environ.update(PYTHONUTF8="1", MPLBACKEND="Agg")
# Commands leave out the folder of the scripts: Snakemake runs a job again if its command changes.
SCRIPTS = str(WORKFLOW / "scripts")
SOCKETS = TemporaryDirectory(prefix="disc_model", ignore_cleanup_errors=True)
WARM = [f"{SCRIPTS}/warm.py", f"{SOCKETS.name}/warm"]
START = shlex.join([INTERPRETER, "-IS", *WARM])
PREFIX = f'set -euo pipefail; job() {{ {START} {shlex.quote(SCRIPTS)}/"$1.py" "${{@:2}}"; }}; '
shell.prefix(PREFIX.replace("{", "{{").replace("}", "}}"))

# Copies of this process run jobs, with one thread as they have. It starts early, to be ready when the first job is,
# and ends with this one, which holds its input.
MAIN = getattr(workflow, "is_main_process", True)
LOCAL = MAIN and not (CONDA or workflow.output_settings.dryrun or workflow.nodes)
if LOCAL and sys.platform == "linux":
    LIBRARIES = ("OMP", "GOTO", "OPENBLAS", "MKL", "VECLIB", "NUMEXPR")
    ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in LIBRARIES}
    STREAMS = {"stdin": PIPE, "stdout": DEVNULL, "stderr": DEVNULL}
    warm = Popen([sys.executable, *WARM], env=os.environ | ONE_THREAD, **STREAMS)
    Path(SOCKETS.name, "started").write_text(str(warm.pid))  # jobs wait for it
    finalize(workflow, warm.kill)

try:
    from disc_model.figures.schema import Plot
    from disc_model.errors import DiscModelError
    from disc_model.sources import (
        BATCHES,
        MERGING,
        PHYSICS,
        quantity_file,
        source_hash,
    )
    from disc_model.studies.study import (
        mapping,
        read_file,
        read_files,
        study_from_config,
    )

    # Imports of the jobs, so that a dry run does not succeed where they would fail.
    for module in () if CONDA else ("numba", "netCDF4", "matplotlib", "cmcrameri"):
        if find_spec(module) is None:
            raise ModuleNotFoundError(name=module)
except ModuleNotFoundError as error:
    raise WorkflowError(
        f"There is no module {error.name}: `pip install 'disc_model[workflow]'`, or `make env` in a clone of the"
        " repository, brings all that is needed; use that environment's snakemake."
    ) from None

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


FOLDERS = [Path(file).parent for file in workflow.configfiles]
try:
    STUDY = study_from_config(config, workflow.configfiles)
    # ASKED are the grids whose figures are requested; a figure may show further ones.
    GRIDS, ASKED = STUDY.grids([Path(), *FOLDERS, WORKFLOW.parent])
except DiscModelError as error:
    raise WorkflowError(str(error)) from None

RESULTS = f"results/{STUDY.name}"

if CONDA and not SOURCES.is_dir():
    raise WorkflowError(
        "With conda the workflow is run from a clone of its repository, where the package's sources are."
    )


wildcard_constraints:
    study="|".join(GRIDS) or "none",
    batch=r"[0-9a-f]{12}",
    key=r"[0-9a-f]{12}",
    case="|".join(STUDY.specs) or "none",
    target="(_avx2)?",


def code_of(rule, *parts):
    """Hash of a rule's script and of parts of the package, as a parameter of the rule.

    By it Snakemake runs a rule again after a change of its sources, which it does not see by itself. What the physics
    decides need not be among the parts where results are the input, because those are newer then.
    """
    return source_hash(Path(SCRIPTS, f"{rule}.py"), *parts)
