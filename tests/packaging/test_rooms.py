"""Who follows a study file, a case or a grid point through the package has few rooms to look into.

A room is a file of the package outside the engine; it is entered when a function of it runs, importing it aside.
"""

import importlib
import inspect
import io
import json
import subprocess
import sys
from pathlib import Path
from types import FrameType

import pytest

import disc_model

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = f"{Path(disc_model.__file__).resolve().parent}/"
CONFIG = ROOT / "config" / "test.yaml"
SCRIPTS = ("simulate_case", "draw_figure", "compute_batch")
ROOMS: dict[str, None] = {}


def look(frame: FrameType, event: str, _: object) -> None:
    file = frame.f_code.co_filename
    if event != "call" or not file.startswith(PACKAGE) or file.startswith(f"{PACKAGE}engine/"):
        return
    around: FrameType | None = frame
    while around and not (around.f_code.co_name == "<module>" and around.f_code.co_filename.startswith(PACKAGE)):
        around = around.f_back
    if frame.f_code.co_flags & inspect.CO_OPTIMIZED and not around:  # bodies of classes are no functions
        ROOMS[file.removeprefix(PACKAGE)] = None


def follow(way: str, folder: Path) -> None:
    """From the text of a study to what its batches are told, to Fig. 2, or to the dataset of a grid's first point."""
    from disc_model.figures.paper.catalogue import CATALOGUE
    from disc_model.studies.study import load_study

    simulate, draw, compute = (importlib.import_module(name).main for name in SCRIPTS)
    sys.setprofile(look)
    if way == "file":
        path = ROOT / "config" / "studies" / "test" / "test_grid.yaml"
        grids, _ = load_study(path).grids([path.parent])
        (folder / "written").write_text(json.dumps(dict(grids["test_grid"].batches)))
        return
    study = load_study(CONFIG)
    if way == "case":
        simulate(study.specs["F02"].canonical, str(folder / "F02.nc"))
        plot = CATALOGUE["fig02"].plot.model_dump_json()
        draw(plot, "", str(folder / "written.pdf"), str(folder / "written.png"), f"F02={folder / 'F02.nc'}")
    else:
        grids, _ = study.grids([ROOT])
        batch = json.loads(next(iter(grids["test_grid"].batches.values())))
        sys.stdin = io.StringIO(json.dumps(batch | {"points": batch["points"][:1]}))
        compute(str(folder / "written.nc"))


@pytest.mark.compiled
@pytest.mark.parametrize(("way", "most"), [("file", 5), ("case", 16), ("point", 24)])
def test_a_way_enters_few_rooms(way: str, most: int, tmp_path: Path) -> None:
    """In a process of its own: what is remembered from before would not be entered again."""
    command = [sys.executable, "-m", "tests.packaging.test_rooms", way, str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rooms = json.loads(done.stdout.splitlines()[-1])
    assert list(tmp_path.glob("written*"))
    assert {"studies/document.py", "studies/study.py"} <= set(rooms)
    assert len(rooms) <= most, rooms


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "workflow" / "scripts"))
    follow(sys.argv[1], Path(sys.argv[2]))
    sys.setprofile(None)
    print(json.dumps(list(ROOMS)))
