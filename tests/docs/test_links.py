"""Links between pages lead somewhere, and what texts mention exists: files, layers, names."""

import pydoc
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "results" / "README.md"]
PAGES += sorted(path for path in DOCS.rglob("*.md") if "_build" not in path.parts)
SOURCES = [*sorted((ROOT / "src").rglob("*.py")), *sorted((ROOT / "workflow").rglob("*.*"))]
TEXTS = PAGES + [path for path in SOURCES if path.suffix not in (".pyc", ".png")]
ARCHITECTURE = (DOCS / "architecture.md").read_text(encoding="utf-8")
PATHS = sorted(set(re.findall(r"`([\w./-]+(?:/|\.(?:py|yaml|smk|toml)))`", ARCHITECTURE)))
NO_MODULES = {"yaml", "mplstyle", "post", "egg"}
"""What follows the package's name in names of files."""
DOTTED = re.compile(r"\bdisc_model(?:\.[A-Za-z_]\w*)+")


def name(path: Path) -> str:
    """Return a path from the root."""
    return str(path.relative_to(ROOT))


# ---- Links


def anchor(heading: str) -> str:
    """Return the anchor of a heading, as MyST and GitHub make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def links_of(page: Path) -> list[str]:
    """Return the targets of a page's links to files and headings."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    targets = re.findall(r"\]\(([^)\s]+)\)", text)
    outside = re.compile(r"mailto:|[a-z]+://")
    return [target for target in targets if not outside.match(target)]


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in links_of(page):
        file, _, place = target.partition("#")
        found = page
        if file:
            found = (page.parent / file).resolve()
        assert found.exists(), target
        if DOCS in page.parents and found.suffix == ".md":
            assert DOCS in found.parents, f"{target}: the site has no such page"
        if place:
            headings = re.findall(r"^#+ (.*)$", found.read_text(encoding="utf-8"), re.M)
            assert place in map(anchor, headings), target


# ---- Names and paths


def exists(dotted: str) -> bool:
    """Return whether a dotted name is that of a module, or of something in one.

    A field may have no value.
    """
    if pydoc.locate(dotted) is not None:
        return True
    owner, _, member = dotted.rpartition(".")
    return member in getattr(pydoc.locate(owner), "__annotations__", {})


def test_names_of_the_package_exist() -> None:
    wrong = []
    for path in TEXTS:
        for dotted in set(DOTTED.findall(path.read_text(encoding="utf-8"))):
            if dotted.split(".")[1] not in NO_MODULES and not exists(dotted):
                wrong.append(f"{name(path)}: {dotted}")
    assert not wrong


@pytest.mark.parametrize("path", PATHS)
def test_every_path_exists(path: str) -> None:
    for place in (ROOT / path, ROOT / "src" / "disc_model" / path):
        if place.is_dir() if path.endswith("/") else place.is_file():
            return
    pytest.fail(f"{path}: there is no such path")
