"""Where results come from, and those of which Snakemake has no record."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from snakemake.persistence.file import FilePersistence
from snakemake.settings.enums import PersistenceBackend

from disc_model.data import provenance
from disc_model.data.provenance import PACKAGE, git_commit, source_files, source_hash, unrecorded, versions, why_unknown
from disc_model.figures.paper.catalogue import CATALOGUE


def names(*modules: str) -> set[str]:
    return {path.relative_to(PACKAGE).as_posix() for path in source_files(*modules)}


def test_a_simulation_depends_on_the_whole_engine_and_on_no_figure_or_claim() -> None:
    found = names("disc_model.simulation.api")
    imported = {path.relative_to(PACKAGE).as_posix() for path in (PACKAGE / "engine").glob("*.py")}
    simulation = {f"simulation/{name}.py" for name in ("api", "case", "result", "kept")}
    assert {"parameters.py", "plate.py", "data/dataset.py", *simulation} <= found
    assert "engine/machine.py" in found
    unused = imported - found
    assert not {name for name in unused if "switch" in name or "series" in name}
    assert not {name for name in found if name.startswith(("figures/", "claims/")) or name == "studies/study.py"}


@pytest.mark.parametrize("figure", CATALOGUE)
def test_a_figure_depends_on_its_module_and_the_style_but_not_on_the_solver(figure: str) -> None:
    def file_of(name: str) -> str:
        return CATALOGUE[name].plot.module.removeprefix("disc_model.").replace(".", "/") + ".py"

    found = names(CATALOGUE[figure].plot.module)
    assert {file_of(figure), "figures/parts.py"} <= found
    assert not {name for name in found if name.startswith(("engine/", "claims/")) or name == "simulation/api.py"}
    # figures of one kind share a module; another kind's module must not make this one be drawn again
    assert not ({file_of(other) for other in CATALOGUE} - {file_of(figure)}) & found


def test_imports_of_every_kind_are_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "disc_model"
    (package / "sub").mkdir(parents=True)
    sources = {
        "__init__.py": "",
        "top.py": "import disc_model.a\nfrom disc_model import b\nfrom disc_model.sub import c\nimport os",
        "a.py": "def f():\n    from .sub.d import g",
        "b.py": "if TYPE_CHECKING:\n    from . import checked\nelse:\n    from . import f",
        "f.py": "",
        "sub/__init__.py": "",
        "sub/c.py": "from . import e\nfrom .. import top",
        "sub/d.py": "",
        "sub/e.py": "",
        "checked.py": "",
        "unused.py": "",
    }
    for name, text in sources.items():
        (package / name).write_text(text)
    monkeypatch.setattr(provenance, "PACKAGE", package)
    found = {path.relative_to(package).as_posix() for path in source_files("disc_model.top")}
    assert found == set(sources) - {"__init__.py", "checked.py", "unused.py"}
    script = tmp_path / "job.py"
    script.write_text("from disc_model.sub import e\n")
    assert set(source_files(script)) == {script, package / "sub" / "__init__.py", package / "sub" / "e.py"}
    before = source_hash("disc_model.top")
    (package / "unused.py").write_text("x = 1")
    assert source_hash("disc_model.top") == before
    (package / "sub" / "d.py").write_text("x = 1")
    assert source_hash("disc_model.top") != before


BODY = "import os\n\ndef f(x, *, y=1.0):\n    return [x, 'text', None] + y\n"


@pytest.mark.parametrize(
    ("text", "same"),
    [
        (BODY, True),
        ("# a comment\n" + BODY, True),
        ('"""A docstring."""\n' + BODY, True),
        (BODY.replace("y=1.0", "\n    y = 1.00,\n"), True),
        (BODY.replace("    return", '    """What it does."""\n\n    return'), True),
        (BODY.replace("'text'", '"text"'), True),
        (BODY + "if TYPE_CHECKING:\n    import sys\n", True),
        (BODY.replace("text", "test"), False),
        (BODY.replace("1.0", "1"), False),
        (BODY.replace("None", "False"), False),
        (BODY.replace(", None", ""), False),
        (BODY.replace("*, ", ""), False),
        (BODY.replace("+ y", "- y"), False),
        (BODY.replace("import os", "import sys"), False),
        (BODY.replace("import os", "import os as sys"), False),
        (BODY + "f(1)\n", False),
        (BODY + "if TYPE_CHECKING:\n    pass\nelse:\n    import sys\n", False),
    ],
)
def test_code_counts_and_what_is_said_of_it_does_not(text: str, same: bool, tmp_path: Path) -> None:
    script = tmp_path / "job.py"
    script.write_text(BODY)
    before = source_hash(script)
    script.write_text(text)
    assert (source_hash(script) == before) == same


def test_the_hash_does_not_depend_on_the_version_of_python(tmp_path: Path) -> None:
    """Results may be computed on several machines. `ast.dump` says more in some versions than in others."""
    script = tmp_path / "job.py"
    script.write_text(BODY + "class A(int):\n    a: int = 1\n    async def f(self): return f'{self!r:>3}' or {**x}\n")
    assert source_hash(script) == "97fd49b465e424e4"


def test_further_files_count(tmp_path: Path) -> None:
    file = tmp_path / "style"
    file.write_text("a")
    first = source_hash("disc_model.errors", files=[file])
    file.write_text("b")
    assert source_hash("disc_model.errors", files=[file]) != first != source_hash("disc_model.errors")


def test_versions_and_commit_are_text() -> None:
    assert set(provenance.VERSIONS_OF) | {"python"} == set(versions())
    assert all(isinstance(text, str) and text for text in (*versions().values(), git_commit()))


def test_the_commit_of_another_repository_is_not_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The package may be installed in an environment that lies in somebody's own repository."""
    site = tmp_path / "venv" / "disc_model"
    site.mkdir(parents=True)
    (site / "__init__.py").write_text("")
    identity = ("-c", "user.name=somebody", "-c", "user.email=somebody@example.org")
    for command in (("init", "-q"), (*identity, "commit", "-q", "--allow-empty", "-m", "own work")):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    monkeypatch.setattr(provenance, "PACKAGE", site)
    assert git_commit.__wrapped__() == "unknown"
    subprocess.run(["git", "add", "."], cwd=tmp_path, check=True)
    subprocess.run(["git", *identity, "commit", "-q", "-m", "all of it"], cwd=tmp_path, check=True)
    assert len(git_commit.__wrapped__()) == 40


def test_results_without_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = {"recorded": "YQ==", "cut": "Yg==", "unfinished": "Yw==", "absent": "ZA=="}  # a, b, c, d
    for folder in ("metadata", "incomplete"):
        Path(".snakemake", folder).mkdir(parents=True)
    Path(".snakemake/metadata", names["recorded"]).write_text('{"rule": "r"}')
    Path(".snakemake/metadata", names["cut"]).write_text('{"ru')
    Path(".snakemake/incomplete", names["unfinished"]).write_text("{}")
    for file in ("a", "b", "c", "e"):
        Path(file).touch()
    assert unrecorded(["a", "b", "c", "d", "e"]) == ["b", "e"]


def workflow(backend: PersistenceBackend = PersistenceBackend.FILE) -> SimpleNamespace:
    return SimpleNamespace(workflow_settings=SimpleNamespace(persistence_backend=backend))


def test_this_snakemake_is_known() -> None:
    assert why_unknown(workflow()) == ""


def test_a_database_is_not_looked_into() -> None:
    assert why_unknown(workflow(PersistenceBackend.DB)) == "they are in a database"


@pytest.mark.parametrize("module", ["snakemake.persistence.file", "snakemake.settings.enums"])
def test_a_module_that_is_gone(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    assert module in why_unknown(workflow())


def test_a_function_that_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(FilePersistence, "_record_path")
    assert "_record_path" in why_unknown(workflow())


def test_a_setting_that_is_gone() -> None:
    assert "workflow_settings" in why_unknown(SimpleNamespace())


def test_other_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FilePersistence, "_record_path", lambda self, folder, name: f"{folder}/{name}")
    assert why_unknown(workflow()) == "one is called metadata/results/paper/cases/F02.nc"
