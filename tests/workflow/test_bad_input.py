"""Bad study files end Snakemake before any job, with every fault in the message."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.workflow.conftest import SMALL, STUDIES, Project, copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]


FAULTS = [f"{SMALL}: 2 faults", "cases.X.parameters.N = -5: must be >= 0", "cases.X.t_end = 0: must be > 0"]


@pytest.mark.parametrize(
    ("file", "old", "new", "faults"),
    [
        (SMALL, "N: 200, Omega: 20}, t_end: 2}", "N: -5, Omega: 20}, t_end: 0}", FAULTS),
        # which Snakemake itself would end in a traceback
        ("config/paper.yaml", "\ntitle: ", "\ntitle: [", ["config/paper.yaml: 1 fault", "line "]),
    ],
    ids=["values", "no YAML"],
)
def test_every_fault_is_shown_and_nothing_runs(
    project: Project, file: str, old: str, new: str, faults: list[str]
) -> None:
    project.edit(file, old, new)
    shown = replace(project, config=SMALL if file == SMALL else None).refused("-j2")
    assert [fault for fault in faults if fault not in shown] == []
    assert "Traceback" not in shown
    assert "Job stats" not in shown


def test_results_of_another_study_of_the_same_name_are_not_overwritten(tmp_path: Path) -> None:
    """They were, without a word."""
    project = copy_repository(tmp_path / "project", {"first.yaml": STUDIES["config/small_growth.yaml"]})
    project.complete("check", "-j1")  # a run in which nothing is computed
    (project.folder / "second.yaml").write_text((project.folder / "first.yaml").read_text().replace("25", "30"))
    second = replace(project, config="second.yaml")
    shown = second.refused("-j1", "-n")
    assert "study = 'small_growth': is also the name of the study in first.yaml, whose results are in" in shown
    assert "Job stats" not in shown
    (project.folder / "first.yaml").rename(project.folder / "third.yaml")
    assert "Job stats" in second.complete("-n")
