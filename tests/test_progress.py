"""What is shown of long work: on a terminal, in a notebook, elsewhere."""

import builtins
import io
import sys
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numba
import pytest

from disc_model import Execution, Parameters, progress, simulate
from disc_model.progress import COMPILING, compiling, simulating
from disc_model.simulation import api

P = Parameters(N=200, Omega=50, n_diameters=1)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def watched(where: str, monkeypatch: pytest.MonkeyPatch) -> Callable[[], list[str]]:
    """A terminal, a notebook or a file to show things in; the function tells what was shown so far."""
    stream = Terminal() if where == "terminal" else io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    if where != "notebook":
        return lambda: stream.getvalue().splitlines()
    told: list[str] = []

    def display(data: dict[str, str], raw: bool, display_id: bool = False) -> Any:
        told.append(data["text/plain"])
        return SimpleNamespace(update=display)

    shell = type("ZMQInteractiveShell", (), {})()
    monkeypatch.setattr(builtins, "get_ipython", lambda: shell, raising=False)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display))
    return lambda: list(told)


EVERYWHERE = pytest.mark.parametrize("where", ["terminal", "notebook", "file"])


@EVERYWHERE
def test_a_long_simulation_is_shown(where: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Outside of the command line it never was, and there only on a terminal."""
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setattr(api, "STEPS_PER_PAUSE", 10)  # as if it were long: it pauses
    texts = watched(where, monkeypatch)
    simulate(P, 0.05)
    if where == "terminal":
        assert "simulating: 0.05 of 0.05 s" in "".join(texts())
    else:
        assert texts()[0] == "simulating 0.05 s"
        assert texts()[-1] == "simulated 0.05 s in 0 s"
        assert (len(texts()) > 2) == (where == "notebook")


@EVERYWHERE
@pytest.mark.parametrize("patience", [0.0, 60.0])
def test_what_is_short_or_to_be_silent_is_not(where: str, patience: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", patience)
    texts = watched(where, monkeypatch)
    simulate(P, 0.05, execution=Execution(progress=None if patience else False))
    assert not texts()


def test_a_bar_goes_no_further_than_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    texts = watched("notebook", monkeypatch)
    with simulating(None, 4.0) as tell:
        tell(1.0)
        tell(9.0)
    assert texts()[1:3] == ["█" * 8 + "░" * 22 + " simulating: 1.00 of 4 s", "█" * 30 + " simulating: 4.00 of 4 s"]


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
@EVERYWHERE
@pytest.mark.parametrize("told", [True, False])
def test_kernels_that_are_compiled_are_told(where: str, told: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the number of their parts; nothing where all are there already."""
    monkeypatch.setattr(progress, "UNNOTICED", 0.0)
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) + 1)
    texts = watched(where, monkeypatch)
    with compiling(told):
        with compiling():
            outer(1)
        outer(2)
    shown = texts()
    if not told:
        assert not shown
    elif where == "terminal":
        assert f"{COMPILING}, 2 parts done" in "".join(shown)
    else:
        assert (shown[0], shown[-1][:19]) == (COMPILING, "kernels compiled in")
    with compiling():
        outer(3)
    assert texts() == shown
