"""Follow a study file, a case or a grid point from its file to what is written, and list the rooms entered.

A room is a file of the package; it is entered when a function of it runs.

python -m tests.packaging.rooms file|case|point FOLDER    prints them as JSON; what is written goes to FOLDER
"""

from __future__ import annotations

import importlib
import inspect
import io
import json
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType

import yaml

import disc_model

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(disc_model.__file__).resolve().parent
CONFIG = ROOT / "config" / "test.yaml"
sys.path.insert(0, str(ROOT / "workflow" / "scripts"))


def entered(way: Callable[[], None]) -> list[str]:
    """The rooms outside the engine, in the order in which they are entered; importing one does not count."""
    rooms: dict[str, None] = {}

    def look(frame: FrameType, event: str, _: object) -> None:
        file = frame.f_code.co_filename
        if event != "call" or not file.startswith(f"{PACKAGE}/") or file.startswith(f"{PACKAGE}/engine/"):
            return
        if not frame.f_code.co_flags & inspect.CO_OPTIMIZED or _importing(frame):
            return
        rooms.setdefault(Path(file).relative_to(PACKAGE).as_posix())

    threading.setprofile(look)
    sys.setprofile(look)
    try:
        way()
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    return list(rooms)


def _importing(frame: FrameType | None) -> bool:
    """Whether a module of the package is being executed; classes are bodies of code as well, and no functions."""
    while frame is not None:
        if frame.f_code.co_name == "<module>" and frame.f_code.co_filename.startswith(str(PACKAGE)):
            return True
        frame = frame.f_back
    return False


def run(script: str, *arguments: str) -> None:
    """A script of the workflow, as its job calls it."""
    importlib.import_module(script).main(*arguments)


def file(folder: Path) -> None:
    """A study file from YAML to the texts of its batches."""
    from disc_model.studies.study import load_study

    path = ROOT / "config" / "studies" / "test" / "test_grid.yaml"
    grids, _ = load_study(path).grids([path.parent])
    (folder / "batches.json").write_text(json.dumps(dict(grids["test_grid"].batches)))


def case(folder: Path) -> None:
    """F02 of config/test.yaml: its text, its dataset and Fig. 2."""
    from disc_model.figures.paper.catalogue import CATALOGUE, caption
    from disc_model.studies.study import study_from_config

    study = study_from_config(yaml.safe_load(CONFIG.read_text(encoding="utf-8")), [CONFIG])
    dataset = str(folder / "F02.nc")
    run("simulate_case", study.specs["F02"].canonical, dataset)
    plot, out = CATALOGUE["fig02"].plot.model_dump_json(), str(folder / "fig02.png")
    title = caption(
        "fig02",
        {name: spec.parameters for name, spec in study.specs.items()},
        {name: spec.sections for name, spec in study.specs.items()},
    )
    run("draw_figure", plot, title, out.replace("png", "pdf"), out, f"F02={dataset}")


def point(folder: Path) -> None:
    """The first batch of the grid of outcomes that config/test.yaml asks for, with its first point alone."""
    from disc_model.studies.study import study_from_config

    study = study_from_config(yaml.safe_load(CONFIG.read_text(encoding="utf-8")), [CONFIG])
    grids, _ = study.grids([ROOT])
    batch = json.loads(next(iter(grids["test_grid"].batches.values())))
    sys.stdin = io.StringIO(json.dumps(batch | {"points": batch["points"][:1]}))
    run("compute_batch", str(folder / "batch.nc"))


if __name__ == "__main__":
    for script in ("simulate_case", "draw_figure", "compute_batch"):  # as each job does before its work
        importlib.import_module(script)
    ways = {"file": file, "case": case, "point": point}
    which, there = ways[sys.argv[1]], Path(sys.argv[2])
    print(json.dumps(entered(lambda: which(there))))
