"""The sources on which results depend: what decides them is in, and what does not is left out."""

import ast
import re
import subprocess
from pathlib import Path

import pytest

from disc_model import sources
from disc_model.sources import (
    BATCHES,
    MERGING,
    PACKAGE,
    PHYSICS,
    TABLE,
    code_hash,
    git_commit,
    quantity_file,
    source_hash,
)
from disc_model.studies.registry import QUANTITIES

BODY = "import os\n\ndef f(x, *, y=1.0):\n    return [x, 'text', None] + y\n"
ASIDE = {  # imported by the physics, but deciding no result, with the reason
    "data.coded": "words of tables of text",
    "data.complex_parts": "numbers of tables of text",
    "data.described": "says what variables are where files are read",
    "data.swept_branches": "reads branches of sweeps, of which studies make none",
    "display": "shows to a reader",
    "sources": "is this module",
    "studies.registry": "names all quantities, of which a batch states its own",
}


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
def test_code_counts_and_what_is_said_of_it_does_not(text: str, same: bool, tmp_path: Path) -> None:
    hashes = []
    for folder, content in {"a": BODY, "b": text}.items():
        path = tmp_path / folder / "job.py"
        path.parent.mkdir()
        path.write_text(content)
        hashes.append(source_hash(path))
    assert (hashes[0] == hashes[1]) == same


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ('long_name = "contact force"', 'long_name = "force"', True),
        ('missing = "there is no cycle"', 'missing = "none"', True),
        ('dims = ["curve"]', 'dims = ["curves"]', False),
        ('no_yes = ["no", "yes"]', 'no_yes = ["yes", "no"]', False),
        ("whole = true", "whole = false", False),
    ],
)
def test_words_of_the_table_of_variables_change_no_number(
    old: str, new: str, same: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A word less in a long name cost 275 of 275 jobs."""
    text = (PACKAGE / TABLE).read_text()
    assert old in text
    hashes = []
    for folder, content in {"a": text, "b": text.replace(old, new)}.items():
        path = tmp_path / folder / TABLE
        path.parent.mkdir(parents=True)
        path.write_text(content)
        monkeypatch.setattr(sources, "PACKAGE", tmp_path / folder)
        source_hash.cache_clear()
        hashes.append((source_hash(TABLE), source_hash("data")))
    source_hash.cache_clear()
    assert (hashes[0][0] == hashes[1][0]) == same
    assert hashes[0][1] != hashes[1][1], "merging and drawing say the new words"


def test_hashes_of_code_are_kept_for_later_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the file's content: a file that has changed is read anew, and a damaged line is left out."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "job.py"
    path.write_text("x = 1")

    def in_a_new_process() -> str:
        code_hash.cache_clear()
        sources._known_hashes.cache_clear()
        return code_hash(path)

    first = in_a_new_process()
    [kept] = (tmp_path / "cache").glob("code-*.txt")
    line = kept.read_text()
    assert line.split()[1] == first
    monkeypatch.setattr(sources.ast, "dump", None)  # no file is read again
    assert in_a_new_process() == first

    monkeypatch.undo()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    path.write_text("x = 2")
    second = in_a_new_process()
    assert second != first
    kept.write_text(f"{line[:100]}\n")
    assert in_a_new_process() == second
    sources._known_hashes.cache_clear()


def test_names_and_data_of_a_folder_count(tmp_path: Path) -> None:
    def changed(name: str, content: str) -> str:
        (tmp_path / name).write_text(content)
        source_hash.cache_clear()
        code_hash.cache_clear()
        return source_hash(tmp_path)

    hashes = [changed("a.py", "x = 1"), changed("a.toml", "x = 1"), changed("a.toml", "x = 2")]
    assert len({*hashes}) == 3
    (tmp_path / "a.toml").rename(tmp_path / "b.csv")
    source_hash.cache_clear()
    assert source_hash(tmp_path) not in hashes


def test_a_part_that_is_not_there_is_an_error() -> None:
    with pytest.raises(FileNotFoundError, match="no_such_part"):
        source_hash("no_such_part")
    assert len(source_hash(*BATCHES, *MERGING, "figures")) == 16


def modules_of(*parts: str) -> dict[str, Path]:
    """Modules in parts of the package by their names, without `disc_model.`."""
    modules = {}
    for part in parts:
        whole = PACKAGE / part
        for path in [whole] if whole.is_file() else whole.rglob("*.py"):
            if path.suffix == ".py":
                place = path.relative_to(PACKAGE).with_suffix("")
                modules[".".join(place.parts).removesuffix(".__init__")] = path
    return modules


def imports_of(path: Path) -> set[str]:
    """Modules of the package that a module imports, also within functions."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            for alias in node.names:
                found.add(f"{node.module}.{alias.name}")
            found.add(node.module)
    own = {name.removeprefix("disc_model.") for name in found if name.startswith("disc_model.")}
    return {name for name in own if _is_module(name)}


def _is_module(name: str) -> bool:
    return PACKAGE.joinpath(*name.split(".")).with_suffix(".py").is_file()


@pytest.mark.parametrize("parts", [PHYSICS, BATCHES])
def test_what_the_physics_imports_is_among_its_sources(parts: tuple[str, ...]) -> None:
    """A module that is imported and not hashed would leave results that its change has made out
    of date."""
    modules = modules_of(*parts)
    for name, path in modules.items():
        assert imports_of(path) - modules.keys() - ASIDE.keys() == set(), name


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_quantity_depends_on_its_own_file_and_the_physics_alone(quantity: str) -> None:
    path = PACKAGE / quantity_file(quantity)
    assert imports_of(path) - modules_of(*BATCHES).keys() - ASIDE.keys() == set()


# ---- Rules

ROOT = PACKAGE.parents[1]
RULES = "\n".join(path.read_text() for path in sorted((ROOT / "workflow/rules").glob("*.smk")))
HASHED = re.findall(r"code_of\(\s*\"(\w+)\",([^()]*(?:\([^()]*\)[^()]*)?)\)", RULES)
"""Rules, and the parts of the package that they name as their sources."""
STARRED = {
    "*PHYSICS": PHYSICS,
    "*BATCHES": BATCHES,
    "*MERGING": MERGING,
    "*drawing_of(w)": ("figures", "data"),
}
"""Several parts at once, by the words of a rule."""
UNDECISIVE = {  # imported, but deciding no content of a file, with the reason
    **ASIDE,
    "simulation.named_case": "is run before",
    "studies.whole_study": "computes without files",
}


def modules_behind(script: Path, known: set[str]) -> set[str]:
    """Modules of the package that a script imports, and those that these import, without known
    ones and what those import."""
    found: set[str] = set()
    waiting = [script]
    while waiting:
        path = waiting.pop()
        waiting += _folders_behind(path)
        new = imports_of(path) - known - found
        waiting += [PACKAGE.joinpath(*name.split(".")).with_suffix(".py") for name in new]
        found |= new
    return found


def _folders_behind(path: Path) -> list[Path]:
    """First files of the folders of the package from which a module imports."""
    found = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("disc_model."):
            first = PACKAGE.parent.joinpath(*str(node.module).split("."), "__init__.py")
            if first.is_file() and first != path:
                found.append(first)
    return found


@pytest.mark.parametrize(("rule", "words"), HASHED)
def test_a_rule_names_the_parts_that_its_script_imports(rule: str, words: str) -> None:
    """The explorer kept names and colours of classes that had changed in the figures.

    What the physics decides reaches a rule by its input, so that only what lies above counts.
    """
    parts: list[str] = []
    for word in filter(None, map(str.strip, words.split(","))):
        parts += STARRED.get(word, () if word.startswith("own_file") else [word.strip('"')])
    known = {*modules_of(*BATCHES), *UNDECISIVE}
    behind = modules_behind(ROOT / "workflow/scripts" / f"{rule}.py", known)
    left_out = behind - modules_of(*parts).keys()
    assert not left_out, f'code_of("{rule}", ...) leaves out {", ".join(sorted(left_out))}'


def test_no_result_depends_on_figures() -> None:
    assert not [name for name in modules_of(*BATCHES) if name.split(".")[0] == "figures"]


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
