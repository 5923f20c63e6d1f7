"""Links between pages lead somewhere; files, layers and names of the package that texts mention
exist."""

import pydoc
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "results" / "README.md"]
PAGES += sorted(path for path in (ROOT / "docs").rglob("*.md") if "_build" not in path.parts)
TEXTS = [*PAGES, *sorted((ROOT / "src").rglob("*.py")), *sorted((ROOT / "workflow").rglob("*.*"))]
TEXTS = [path for path in TEXTS if "__pycache__" not in path.parts]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PATHS = sorted(set(re.findall(r"`([\w./-]+(?:/|\.(?:py|yaml|smk|toml)))`", PAGE)))
sys.path.insert(0, str(ROOT / "docs" / "drawings"))
import layers  # noqa: E402

NO_MODULES = {"yaml", "mplstyle", "post", "egg"}
"""What follows the package's name in names of files."""


def name(path):
    return str(path.relative_to(ROOT))


def anchor(heading):
    """As MyST and GitHub make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page):
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if "://" in target or target.startswith("mailto:"):
            continue
        file, _, place = target.partition("#")
        found = (page.parent / file).resolve() if file else page
        assert found.exists(), target
        if ROOT / "docs" in page.parents and found.suffix == ".md":
            assert ROOT / "docs" in found.parents, f"{target}: the site has no such page"
        if place:
            headings = re.findall(r"^#+ (.*)$", found.read_text(encoding="utf-8"), re.M)
            assert place in map(anchor, headings), target


def exists(dotted):
    """Whether a dotted name is that of a module, or of something in one; a field may have no
    value."""
    owner, _, name = dotted.rpartition(".")
    return pydoc.locate(dotted) is not None or name in getattr(
        pydoc.locate(owner), "__annotations__", {}
    )


def test_names_of_the_package_exist():
    wrong = []
    for path in TEXTS:
        for dotted in set(
            re.findall(r"\bdisc_model(?:\.[A-Za-z_]\w*)+", path.read_text(encoding="utf-8"))
        ):
            if dotted.split(".")[1] not in NO_MODULES and not exists(dotted):
                wrong.append(f"{name(path)}: {dotted}")
    assert not wrong


@pytest.mark.parametrize("path", PATHS)
def test_every_path_exists(path):
    found = (ROOT / path, ROOT / "src" / "disc_model" / path)
    assert any(place.is_dir() if path.endswith("/") else place.is_file() for place in found)


def test_every_layer_is_in_the_picture():
    """In the order in which `lint-imports` holds them; `make drawings` draws it anew."""
    drawn = re.findall(
        r'class="name"[^>]*>(\w+)<',
        (ROOT / "docs" / "drawings" / "layers.svg").read_text(encoding="utf-8"),
    )
    assert drawn == [part for layer in layers.layers() for part in layer]
    assert drawn == re.findall(r'class="name"[^>]*>(\w+)<', layers.draw())
