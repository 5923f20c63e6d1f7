# From a study file to its datasets and figures; the workflow itself is in workflow/Snakefile.
#   snakemake -j2                                    the paper's study (config/paper.yaml)
#   snakemake -j2 --configfile config/test.yaml      the same pipeline in small
#   snakemake -j2 --configfile my_study.yaml         a study of your own: docs/studies.md
import os
import sys
from pathlib import Path

# The paper revisited and the benchmark lie beside the package, for this process and for jobs.
ROOT = str(Path(workflow.basedir))
sys.path.insert(0, ROOT)
found = filter(None, [ROOT, os.environ.get("PYTHONPATH")])
os.environ.update(PYTHONPATH=os.pathsep.join(found))


include: "workflow/Snakefile"


# The package can do without these two parts.
if Path(ROOT, "workflow", "paper").is_dir():

    include: "workflow/paper/paper.smk"


if Path(ROOT, "benchmarks").is_dir():

    include: "benchmarks/bench.smk"


# What an included file makes by default is not the default of the file that includes it.
workflow.default_target = "all"
