"""What a terminal shows of a run of Snakemake: what is done and what failed, without the routine of
jobs; faults of the user's, and an interruption, in a line each."""

import logging
import re
import textwrap
import time
from collections.abc import Callable, Iterable
from typing import Any

from disc_model.errors import suggestion

ROUTINE_EVENTS = {"job_info", "shellcmd", "job_started", "job_finished", "group_info"}
ROUTINE_TEXTS = ("Select jobs", "Execute ", "RuleException:\nCalledProcessError")
HEADER = "workflow_started"  # event of a dozen lines about the machine, which are in the log file
GRACE = 0.1  # s in which the main process hears of Ctrl-C, which jobs hear of at the same time
LONGEST_COMMAND = 300  # characters of a failed job's command; a batch's text has thousands

INTERRUPTED = "Interrupted. What is finished is kept, and the same command goes on from there."
LOCKED = (
    "error: another run works in this folder, or a killed one has left its lock. If none is running, the same"
    " command with --unlock removes the lock."
)
_NO_RULE = re.compile(r"MissingRuleException\b[^\n]*\nNo rule to produce (.+?) \(if you use")
_OF_INPUT = re.compile(
    r"InputFunctionException\b.*?\n\s*WorkflowError:\n\s*(.+?)\s*\nWildcards:.*", re.DOTALL
)
_PLACES = re.compile(r'(\n\s*File "[^"\n]+", line \d+, in [^\n]*)+\Z')
_OWN_ERROR = re.compile(r'WorkflowError(?: in file "[^"\n]*", line \d+)?:\n')


class RunMessages(logging.Filter):
    """A filter of Snakemake's log records, which rewords some of them.

    Attributes
    ----------
    targets : function that lists what may be made, for a hint where something else is wanted
    brief : whether the routine of single jobs is left out
    interrupted : whether Ctrl-C was pressed, after which a single line is shown
    """

    def __init__(self, targets: Callable[[], Iterable[str]], *, brief: bool) -> None:
        super().__init__()
        self.targets = targets
        self.brief = brief
        self.interrupted = False
        self.ended = False

    def interrupt(self, *_: Any) -> None:
        """Handle the signal of Ctrl-C as Python does, and remember it."""
        self.interrupted = True
        raise KeyboardInterrupt

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a record is shown."""
        event = str(getattr(record, "event", ""))
        if event == "job_error" and not self.interrupted:
            time.sleep(GRACE)
        if self.interrupted:
            return self._last_line(record)
        if event == "job_error":
            _shorten_command(record)
        if event == HEADER:
            return not self.brief
        text = str(record.msg)
        if record.levelno >= logging.ERROR:
            record.msg = self._reworded(text)
        return not (self.brief and (event in ROUTINE_EVENTS or text.startswith(ROUTINE_TEXTS)))

    def _last_line(self, record: logging.LogRecord) -> bool:
        """Turn the first record after an interruption into the line about it; show no other."""
        first = not self.ended
        self.ended = True
        record.event = None
        record.msg = INTERRUPTED
        return first

    def _reworded(self, text: str) -> str:
        """The text of an error in one line, where it is the user's to mend."""
        if missing := _NO_RULE.match(text):
            target = missing[1]
            return f"error: target={target}: is neither a rule nor a result{self._hint(target)}"
        if text.startswith("LockException"):
            return LOCKED
        if of_input := _OF_INPUT.fullmatch(text):
            return f"error: {of_input[1]}"
        if _OWN_ERROR.match(text):
            text = _PLACES.sub("", text)  # in files of the workflow
        return _OWN_ERROR.sub("error: ", text, count=1)

    def _hint(self, target: str) -> str:
        """The most similar target, or else all that are no files, of which there may be many."""
        targets = [*self.targets()]
        rules = [name for name in targets if "/" not in name]
        hint = suggestion(target, targets, all_of_them=False)
        return hint if hint.startswith(", did you mean") else f" (known: {', '.join(rules)})"


def _shorten_command(record: logging.LogRecord) -> None:
    """Cut the command of a failed job, in which a whole batch may stand."""
    command = getattr(record, "shellcmd", None)
    if isinstance(command, str):
        record.shellcmd = textwrap.shorten(command, LONGEST_COMMAND, placeholder=" ...")
