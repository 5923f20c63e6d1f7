"""Who follows a study file from its text to its batches looks into few modules."""

import json
import pkgutil
import sys
from pathlib import Path
from types import FrameType

import pytest

import disc_model
from tests.processes import run

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = f"{Path(disc_model.__file__).resolve().parent}/"
STUDY = ROOT / "config" / "studies" / "test" / "test_grid.yaml"
ENTERED: dict[str, None] = {}


def look(frame: FrameType, event: str, _: object) -> None:
    """Note the module of a function that is called."""
    if event == "call" and frame.f_code.co_filename.startswith(PACKAGE):
        ENTERED[frame.f_code.co_filename.removeprefix(PACKAGE)] = None


@pytest.mark.compiled
def test_a_study_file_enters_five_modules_on_its_way_to_batches() -> None:
    """In a process of its own: what is remembered from before would not be entered again."""
    entered = json.loads(run(sys.executable, "-m", "tests.packaging.test_rooms").stdout.splitlines()[-1])
    assert {"studies/document.py", "studies/study.py"} <= set(entered)
    assert len(entered) <= 5, entered


if __name__ == "__main__":
    for package in ("studies", "figures"):  # while a module is being made, its functions are called too
        for module in pkgutil.walk_packages([f"{PACKAGE}{package}"], f"disc_model.{package}."):
            pkgutil.resolve_name(module.name)
    sys.setprofile(look)
    grids, _ = sys.modules["disc_model.studies.study"].load_study(STUDY).grids([STUDY.parent])
    assert dict(grids["test_grid"].batches)
    sys.setprofile(None)
    print(json.dumps(list(ENTERED)))
