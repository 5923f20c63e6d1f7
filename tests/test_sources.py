"""The sources on which results depend: what decides them is in, and what does not is left out."""

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from disc_model import sources
from disc_model.sources import ASIDE, PACKAGE, git_commit, source_files, source_hash
from disc_model.studies.quantity import quantity_names

SCRIPTS = Path(__file__).parents[1] / "workflow" / "scripts"
BODY = "import os\n\ndef f(x, *, y=1.0):\n    return [x, 'text', None] + y\n"


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("# a comment\n" + BODY, True),
        ('"""A docstring."""\n' + BODY, True),
        (BODY + '"""What f is."""\n', True),
        (BODY.replace("y=1.0", "\n    y = 1.00,\n"), True),
        (BODY.replace("    return", '    """What it does."""\n\n    return'), True),
        (BODY.replace("text", "test"), False),
    ],
)
def test_code_counts_and_what_is_said_of_it_does_not(
    text: str, same: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where it is not parsed again, and where what was kept of it is damaged."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    paths = [tmp_path / name / "job.py" for name in "ab"]
    for path, content in zip(paths, (BODY, text), strict=True):
        path.parent.mkdir()
        path.write_text(content)
    hashes = [*map(source_hash, paths)]
    assert (hashes[0] == hashes[1]) == same
    for file in (tmp_path / "sources").iterdir():
        file.write_bytes(file.read_bytes()[:-1])
    for _ in range(2):
        forget()
        assert [*map(source_hash, paths)] == hashes
        monkeypatch.setattr(sources, "_parse", None)


SOLVE = """
from typing import TYPE_CHECKING
from . import laws
if TYPE_CHECKING:
    from disc_model import unrelated
else:
    from ..units import METRE
    FOLDER = "static"
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package in the place of ours, of small modules."""
    files = {
        "__init__.py": "from disc_model.deep import unrelated",
        "run.py": "from disc_model.deep.solve import f\ndef later():\n    from . import late, warns",
        "late.py": 'TABLE = open(\'late.csv\'), open("table.toml"), open("more/far.json")',
        "late.csv": "1",
        "warns.py": "import disc_model.unrelated",
        "deep/solve.py": SOLVE,
        "deep/laws.py": "import numpy",
        "units.py": "METRE = 1",
    }
    empty = (
        "table.toml",
        "other.toml",
        "unrelated.py",
        "deep/__init__.py",
        "deep/static/page.js",
        "more/far.json",
    )
    for name, text in (files | dict.fromkeys(empty, "")).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(sources, "PACKAGE", tmp_path)
    monkeypatch.setattr(sources, "ASIDE", {"warns": ""})
    forget()
    yield tmp_path
    forget()


def forget() -> None:
    for function in (source_files, source_hash, sources._read):
        function.cache_clear()


def test_all_that_is_imported_counts_and_the_data_that_it_reads(package: Path) -> None:
    names = {path.relative_to(package).as_posix() for path in source_files("run")}
    deep = {"deep/solve.py", "deep/laws.py", "deep/static/page.js", "units.py"}
    late = {"late.py", "late.csv", "table.toml", "more/far.json"}
    assert names == {"run.py"} | deep | late
    both = {
        path.relative_to(package).as_posix() for path in source_files("disc_model.run", "warns")
    }
    assert both == names | {"warns.py", "unrelated.py"}
    assert len(source_files("deep")) == 5
    with pytest.raises(ModuleNotFoundError, match="missing"):
        source_files("missing")
    (package / "careless.py").write_text("from disc_model import simulate")
    with pytest.raises(ImportError, match="simulate: must be imported from its own module"):
        source_files("careless")


def test_what_decides_a_result_and_no_more_is_among_its_sources() -> None:
    def of(*entries: str | Path) -> set[str]:
        return {
            path.relative_to(PACKAGE).as_posix()
            for path in source_files(*entries)
            if path not in entries
        }

    for name in quantity_names():
        batch = of(SCRIPTS / "compute_batch.py", f"studies.quantities.{name}")
        assert {"engine/series.py", "disc/plate.py", f"studies/quantities/{name}.py"} <= batch
        assert not {path.split("/")[0] for path in batch} & {
            "figures",
            "paper",
            "benchmarks",
            "cli",
            "explorer",
        }
        assert "studies/study.py" not in batch
        short = ("campbell", "floquet", "lyapunov", "ramps", "sliding", "stability_curves")
        assert ("stability/outcome.py" in batch) == (name not in short)
        sweeps = ("basins", "bifurcation", "branches", "hysteresis")
        assert ("stability/lyapunov.py" in batch) == (name in ("lyapunov", *sweeps))
        # one quantity's code is not another's
        others = {f"studies/quantities/{other}.py" for other in quantity_names()} & batch
        assert others == {
            f"studies/quantities/{one}.py" for one in {name, *(["floquet"] * (name == "campbell"))}
        }
    case = of(SCRIPTS / "simulate_case.py")
    assert {"engine/event_loop.py", "simulation/states.py"} <= case
    assert not [path for path in case if path.startswith(("stability", "studies"))]
    assert {"stability/cycle.py", "mode_choice.py"} <= of(
        SCRIPTS / "simulate_case.py", "mode_choice"
    )
    assert {"config/paper.yaml", "paper/section41.yaml"} <= of(SCRIPTS / "check_claims.py")
    figure = of(SCRIPTS / "draw_figure.py")
    assert {"figures/heat_map.py", "figures/kinds/general.py"} <= figure
    assert not [path for path in figure if path.startswith("paper")]
    figure = of(SCRIPTS / "draw_figure.py", "paper.figures.composite")
    assert {"paper/figures/composite.py", "paper/figures/strokes.py"} <= figure
    assert "config/paper.yaml" not in figure
    assert "explorer/static/page.css" in of(SCRIPTS / "build_explorer.py")
    assert {
        "benchmarks/methods/kernels.py",
        "benchmarks/methods/rivals.toml",
        "benchmarks/data/answers.json",
    } <= of(SCRIPTS / "measure.py", "benchmarks.methods", "benchmarks.answers")
    assert "benchmarks/answers.py" not in of(
        SCRIPTS / "measure.py", "benchmarks.methods", "benchmarks.scaling"
    )


def test_what_is_left_aside_is_there_and_scripts_import_from_modules() -> None:
    assert all(map(source_files, ASIDE))
    assert all(script in source_files(script) for script in SCRIPTS.glob("*.py"))


def test_the_commit_of_another_repository_is_not_taken(tmp_path: Path) -> None:
    """The package may be installed in an environment that lies in somebody's own repository."""
    site = tmp_path / "venv" / "disc_model"
    site.mkdir(parents=True)
    (site / "__init__.py").write_text("")
    identity = ("-c", "user.name=somebody", "-c", "user.email=somebody@example.org")
    for command in (("init", "-q"), (*identity, "commit", "-q", "--allow-empty", "-m", "own work")):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    assert git_commit(site) == "unknown"
    subprocess.run(["git", "add", "."], cwd=tmp_path, check=True)
    subprocess.run(["git", *identity, "commit", "-q", "-m", "all of it"], cwd=tmp_path, check=True)
    git_commit.cache_clear()
    assert len(git_commit(site)) == 40
