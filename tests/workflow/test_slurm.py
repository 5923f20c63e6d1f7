"""The SLURM profile on a cluster: every job of a study is run by it, batches in groups, and a group
that takes too long gets more time.

The partition is that of the profile, main, and temporary folders have to be seen by its nodes:
`pytest --basetemp`.
"""

import math
import re
from types import SimpleNamespace

import pytest
from snakemake.cli import parse_args
from snakemake.resources import GroupResources

from tests import needs
from tests.workflow.conftest import ROOT, Project

pytestmark = pytest.mark.slow

PROFILE = "workflow/profiles/slurm"
BATCH = "compute_part"
# Every Python of the project's copy starts with this: the first job that computes a batch hangs.
HANG = """\
import sys
import time
from pathlib import Path

if "part" in sys.orig_argv:
    try:
        Path(__file__).with_name("hanged").touch(exist_ok=False)
    except FileExistsError:
        pass
    else:
        time.sleep(600)
"""


@needs.SLURM.mark
def test_a_study_is_computed_by_the_cluster(project: Project, finished: Project) -> None:
    project.forget()
    (project.folder / "src" / "sitecustomize.py").write_text(HANG)
    project.edit(
        f"{PROFILE}/config.yaml",
        "runtime: 10 * attempt\n    mem_mb: 1200 * attempt\n    in_series",
        "runtime: 1 * attempt\n    mem_mb: 1200 * attempt\n    in_series",
    )
    # two minutes for a group of two, not four for one of four
    project.edit(f"{PROFILE}/config.yaml", "batches=4", "batches=2")
    text = project.complete(
        "--workflow-profile", PROFILE, "--quiet", "host"
    )  # which shows every job
    submitted = re.findall(r"SLURM jobid \d+ \(log: \S*/(rule|group_batches)_(\w+)/", text)
    rules = [rule for kind, rule in submitted if kind == "rule"]
    groups = [rule for kind, rule in submitted if kind == "group_batches"]
    batches = len(list(project.folder.glob("results/*/batches/*.nc")))
    assert groups == [BATCH] * (math.ceil(batches / 2) + 1)
    [announced] = re.findall(r"^total +(\d+)$", text, re.MULTILINE)[:1]
    beside = len(re.findall(r"^localrule \w+:", text, re.MULTILINE))
    assert len(rules) + batches + beside == int(announced)
    assert project.products() == finished.products()


def test_batches_of_a_group_take_turns_on_one_processor() -> None:
    """Without a limit for each group Snakemake asks for as many processors as a group has batches,
    and the plugin for SLURM uses one of them."""
    options = parse_args(["--workflow-profile", str(ROOT / PROFILE)])[1]
    assert options.groups == {BATCH: "batches"}
    size = options.group_components["batches"]
    assert options.set_resource_scopes == dict.fromkeys(options.resources, "local")
    turns = {name: 1 for name in options.resources if name in options.set_resources[BATCH]}
    batch = SimpleNamespace(
        resources={"_cores": 1, "mem_mb": 1200, "runtime": 10, **turns}, pipe_group=None
    )
    job = GroupResources.basic_layered([[batch] * size], options.resources, run_local=False)
    assert job["_cores"] == 1
    assert job["mem_mb"] == 1200
    assert job["runtime"] == 10 * size
