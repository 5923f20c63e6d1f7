"""Bad study files end Snakemake before any job, with every fault in the message."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.workflow.conftest import Project

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

BAD = """\
study: bad
base: {m: 0}
cases:
  F13: {title: growing, parameters: {N: -5, Omega: 15.1, mu_k: 0.5}, t_end: 2, tol: 1}
  X: {title: another, parameters: {N: .nan, Omega: 20, r_0: 0.2, Omga: 3}, t_end: 0}
"""


def test_every_fault_is_shown_and_nothing_runs(project: Project) -> None:
    (project.folder / "config" / "bad.yaml").write_text(BAD)
    shown = replace(project, config="config/bad.yaml").refused("-j2")
    for fault in (
        "config/bad.yaml: 8 faults",
        "base.m = 0: must be > 0",
        "cases.F13.parameters.N = -5: must be >= 0",
        "cases.F13.parameters.mu_k = 0.5: must be <= mu_s=0.4",
        "cases.F13.tol = 1: must be within 1e-15 and 0.01",
        "cases.X.parameters.N = nan: must be finite",
        "cases.X.parameters.r_0 = 0.2: must be <= b=0.12",
        "cases.X.parameters.Omga = 3: unknown parameter, did you mean Omega?",
        "cases.X.t_end = 0: must be > 0",
    ):
        assert fault in shown
    assert "Traceback" not in shown
    assert not (project.folder / "results" / "bad").exists()


def test_keys_given_twice_are_refused(project: Project) -> None:
    project.edit("config/tiny.yaml", "  X:", "  F13:")
    assert "F13: given twice" in project.refused("-j2")


def test_what_is_no_yaml_is_named_with_its_line(project: Project) -> None:
    project.edit("config/paper.yaml", "\ntitle: ", "\ntitle: [")
    shown = replace(project, config=None).refused("-n")
    assert "config/paper.yaml: 1 fault" in shown
    assert "line " in shown
    assert "Traceback" not in shown


def test_lint_passes(project: Project) -> None:
    replace(project, config=None).complete("--lint")
