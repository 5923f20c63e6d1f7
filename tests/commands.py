"""The command line, run in this process."""

import pytest

from disc_model import cli


class Command:
    """The command line, run in this process."""

    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys

    def run(self, *arguments: str) -> tuple[int, str, str]:
        """Exit code, stdout and stderr."""
        with pytest.raises(SystemExit) as ended:
            cli.main(list(arguments))
        shown = self.capsys.readouterr()
        return int(ended.value.code or 0), shown.out, shown.err

    def out(self, *arguments: str) -> str:
        """What a command prints that must succeed."""
        code, out, _ = self.run(*arguments)
        assert code == 0
        return out

    def error(self, *arguments: str) -> str:
        """What a command says that must be refused: one line, with exit code 2."""
        code, out, err = self.run(*arguments)
        assert (code, out) == (2, "")
        assert err.startswith("error: ")
        assert err.count("\n") == 1
        return err
