"""What a terminal shows of a run: records of Snakemake, as it makes them."""

import logging
from typing import Any

import pytest

from disc_model.studies import messages
from disc_model.studies.messages import INTERRUPTED, LOCKED, RunMessages

TARGETS = ["all", "check", "explorer", "results/s/figures/growth.png"]


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> RunMessages:
    monkeypatch.setattr(messages, "GRACE", 0.0)
    return RunMessages(lambda: TARGETS, brief=True)


def record(text: str, level: int = logging.INFO, **extra: Any) -> logging.LogRecord:
    made = logging.LogRecord("snakemake", level, __file__, 1, text, None, None)
    vars(made).update(extra)
    return made


def error(text: str) -> logging.LogRecord:
    return record(text, logging.ERROR, event="error")


def test_the_routine_of_jobs_is_left_out_unless_it_is_asked_for(shown: RunMessages) -> None:
    whole = RunMessages(lambda: TARGETS, brief=False)
    routine = [
        record("", event="workflow_started"),
        record("", event="job_info"),
        record("Finished job 3", event="job_finished"),
        record("Select jobs to execute..."),
        record("Execute 2 jobs..."),
    ]
    assert [shown.filter(each) for each in routine] == [False] * 5
    assert [whole.filter(each) for each in routine] == [True] * 5
    for each in (record("Building DAG of jobs..."), record("", event="progress"), error("no")):
        assert shown.filter(each)


def test_errors_of_the_user_are_said_in_a_line(shown: RunMessages) -> None:
    no_rule = "MissingRuleException:\nNo rule to produce {} (if you use input functions make ...)."
    beginning = "error: target={}: is neither a rule nor a result"
    typo = "results/s/figures/groth.png"
    of_input = (
        'InputFunctionException in rule all in file "/a b/Snakefile", line 54:\nError:\n'
        "  WorkflowError:\n    rerun-triggers=mtime: must ...\nWildcards:\n\nTraceback:\n  File ..."
    )
    cases = {
        no_rule.format("chek"): f"{beginning.format('chek')}, did you mean check?",
        no_rule.format(typo): f"{beginning.format(typo)}, did you mean {TARGETS[-1]}?",
        no_rule.format("x"): f"{beginning.format('x')} (known: all, check, explorer)",
        "LockException:\nError: Directory cannot be locked.": LOCKED,
        of_input: "error: rerun-triggers=mtime: must ...",
        'WorkflowError in file "/a b/common.smk", line 12:\ns.yaml: 1 fault': "error: s.yaml: 1 fault",
        'WorkflowError:\nstudy: taken\n  File "/a b/Snakefile", line 49, in <module>\n'
        '  File "/a b/functions.smk", line 66, in check_owner': "error: study: taken",
        "WorkflowError:\nAt least one job failed.": "error: At least one job failed.",
        "OSError: else": "OSError: else",
    }
    for text, expected in cases.items():
        told = error(text)
        assert shown.filter(told)
        assert told.msg == expected


def test_a_failed_job_does_not_show_all_of_its_batch(shown: RunMessages) -> None:
    command = "job compute_batch results/s/batches/0.nc <<< '" + "[1.0, 2.0], " * 1000
    failed = error("failed")
    vars(failed).update(event="job_error", shellcmd=command)
    assert shown.filter(failed)
    assert failed.shellcmd.startswith("job compute_batch results/s/batches/0.nc")  # type: ignore[attr-defined]
    assert len(failed.shellcmd) <= messages.LONGEST_COMMAND  # type: ignore[attr-defined]


def test_an_interruption_is_one_line_whatever_fails_by_it(shown: RunMessages) -> None:
    """A traceback and kilobytes of a batch's text came from the jobs that were stopped."""
    with pytest.raises(KeyboardInterrupt):
        shown.interrupt(2, None)
    failed = error("failed")
    vars(failed).update(event="job_error", shellcmd="job compute_batch ...")
    said = [record("Terminating processes on user request, this might take some time."), failed,
            error("WorkflowError:\nAt least one job failed.")]  # fmt: skip
    assert [shown.filter(each) for each in said] == [True, False, False]
    # type: ignore[attr-defined]
    assert said[0].msg == INTERRUPTED
    assert said[0].event is None


def test_the_command_of_a_failed_job_is_cut(shown: RunMessages) -> None:
    failed = record("", event="job_error", shellcmd="run " + "point " * 1000)
    shown.filter(failed)
    assert len(failed.shellcmd) <= 300
    assert failed.shellcmd.startswith("run point")
    assert failed.shellcmd.endswith(" ...")
