"""The SLURM profile on a real SLURM: every job of a study is run by it, and one that takes too long gets more time."""

import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import needs
from tests.workflow import slurm
from tests.workflow.conftest import Project
from tests.workflow.slurm import Cluster

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


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Cluster]:
    """SLURM, with the environment that Snakemake needs to find it."""
    for name in [name for name in os.environ if name.startswith(("SLURM_", "SBATCH_", "SRUN_"))]:
        monkeypatch.delenv(name)
    (tmp_path / "slurm").mkdir()
    try:
        with slurm.cluster(tmp_path / "slurm") as running:
            for name, value in running.environment.items():
                monkeypatch.setenv(name, value)
            yield running
    except slurm.Unavailable as error:
        pytest.skip(str(error))


def test_a_study_is_computed_by_the_cluster(cluster: Cluster, project: Project, finished: Project) -> None:
    project.forget()
    (project.folder / "src" / "sitecustomize.py").write_text(HANG)
    project.edit(f"{PROFILE}/config.yaml", "runtime: 30 * attempt", "runtime: 1 * attempt")
    process = project.start("--workflow-profile", PROFILE, prepare=slurm.die_with_parent)
    code, text = process.wait(timeout=1800), (project.folder / "run.log").read_text()
    assert code == 0, text
    submitted = dict(re.findall(r"SLURM jobid (\d+) \(log: \S*/rule_(\w+)/", text))
    ends = Counter(
        (rule == "compute_batch", cluster.finished()[job]["JobState"], cluster.finished()[job]["TimeLimit"])
        for job, rule in submitted.items()
    )
    batches = len(list(project.folder.glob("results/*/batches/*.nc")))
    others = ends.pop((False, "COMPLETED", "10"))
    assert ends == {(True, "TIMEOUT", "1"): 1, (True, "COMPLETED", "2"): 1, (True, "COMPLETED", "1"): batches - 1}
    [announced] = re.findall(r"^total +(\d+)$", text, re.MULTILINE)[:1]
    beside = len(re.findall(r"^localrule \w+:", text, re.MULTILINE))
    assert others + batches + beside == int(announced)
    assert project.products() == finished.products()
