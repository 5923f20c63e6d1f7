"""The SLURM profile on a cluster: every job of a study is run by it, and one that takes too long
gets more time.

The partition is that of the profile, main, and temporary folders have to be seen by its nodes:
`pytest --basetemp`.
"""

import re

import pytest

from tests import needs
from tests.workflow.conftest import Project

pytestmark = [pytest.mark.workflow, pytest.mark.slow, needs.SLURM.mark]

PROFILE = "workflow/profiles/slurm"
# Every Python of the project's copy starts with this: the first job that computes a batch hangs.
HANG = """\
import sys
import time
from pathlib import Path

if any(word.endswith("workflow/scripts/compute_batch.py") for word in sys.orig_argv):
    try:
        Path(__file__).with_name("hanged").touch(exist_ok=False)
    except FileExistsError:
        pass
    else:
        time.sleep(600)
"""


def test_a_study_is_computed_by_the_cluster(project: Project, finished: Project) -> None:
    project.forget()
    (project.folder / "src" / "sitecustomize.py").write_text(HANG)
    project.edit(f"{PROFILE}/config.yaml", "runtime: 30 * attempt", "runtime: 1 * attempt")
    text = project.complete(
        "--workflow-profile", PROFILE, "--quiet", "host"
    )  # which shows every job
    submitted = re.findall(r"SLURM jobid \d+ \(log: \S*/rule_(\w+)/", text)
    batches = len(list(project.folder.glob("results/*/batches/*.nc")))
    assert submitted.count("compute_batch") == batches + 1
    [announced] = re.findall(r"^total +(\d+)$", text, re.MULTILINE)[:1]
    beside = len(re.findall(r"^localrule \w+:", text, re.MULTILINE))
    assert len(submitted) - 1 + beside == int(announced)
    assert project.products() == finished.products()
