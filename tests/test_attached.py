"""Discs and results have the methods whose work is done above them, from wherever they come."""

import pytest

import disc_model
from tests.processes import python


@pytest.mark.parametrize(
    "use",
    [
        "from disc_model.parameters import Disc; Disc.from_csv, Disc.from_uff, Disc.to_csv",
        "import disc_model as dm; dm.Disc.from_section",
        "from disc_model.simulation.result import Result; Result.plot, Result.animate",
        "from disc_model.stability.cycle import FloquetResult; FloquetResult.plot",
        "from disc_model.display import draw",
    ],
)
def test_methods_are_there_whichever_module_is_imported(use: str) -> None:
    heavy = "{'matplotlib', 'disc_model.figures', 'disc_model.disc.table'}"
    shown = python(f"{use}; import sys; print({heavy} & set(sys.modules))").stdout
    assert shown.strip() == "set()"


def test_attaching_imports_no_room() -> None:
    code = "import sys, disc_model; print(*sorted(m for m in sys.modules if 'disc_model' in m))"
    rooms = {name.split(".")[1] for name in python(code).stdout.split() if "." in name}
    assert rooms == {"attachable", "attached", "display"}


def test_help_and_completion_show_attached_methods() -> None:
    """`dir` of a model shows the names of the package, and not those of pydantic."""
    names = dir(disc_model.Disc)
    assert {"from_csv", "from_uff", "from_section", "to_csv", "first"} <= {*names}
    assert "model_dump" not in names
