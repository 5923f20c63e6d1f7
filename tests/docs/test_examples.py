"""The examples of docs/ and of the README do what they say, and everything public has one."""

import doctest
import inspect
import math
import re
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import pytest
from matplotlib import pyplot

import disc_model
from disc_model import Parameters
from disc_model.studies.study import load_study
from tests.disc.table import disc_of
from tests.disc.universal import write_modes
from tests.processes import python

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted({*DOCS.glob("*.md"), *DOCS.glob("howto/*.md"), ROOT / "README.md"})
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)
WITH_EXAMPLES = [page for page in PAGES if ">>>" in page.read_text(encoding="utf-8")]
OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

RETURNED = ["stability.cycle.FloquetResult", "stability.sliding.SteadySliding"]
"""Classes of what functions return."""


def page_name(page: Path) -> str:
    return page.name


def blocks(page: Path) -> list[str]:
    """Return the blocks of Python of a page."""
    return BLOCK.findall(page.read_text(encoding="utf-8"))


# ---- Pages


@pytest.mark.parametrize("page", WITH_EXAMPLES, ids=page_name)
def test_examples_print_what_they_say(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page is one session."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "config"
    path.symlink_to(ROOT / "config")
    session = "\n".join(blocks(page))
    test = doctest.DocTestParser().get_doctest(session, {}, page.name, str(page), 0)
    outcome = doctest.DocTestRunner(optionflags=OPTIONS).run(test)
    assert outcome.attempted > 0
    assert outcome.failed == 0


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_every_example_is_in_a_block_that_is_run(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert text.count(">>> ") == sum(block.count(">>> ") for block in blocks(page))


@pytest.mark.slow
def test_the_script_from_a_universal_file_to_a_file_runs(tmp_path: Path) -> None:
    """It is what a laboratory with the modes of a disc writes, in at most 25 lines."""
    page = DOCS / "howto" / "sweep.md"
    (script,) = [block for block in blocks(page) if "from_uff" in block]
    assert len(script.splitlines()) <= 25
    write_modes(tmp_path / "disc.unv", sets=(2411, 2414), size=1e3)
    done = python(script, cwd=tmp_path)
    assert re.search(r"grow in \d+% of 1000 samples", done.stdout)
    assert "1000/1000" in done.stderr
    map_path = tmp_path / "map.png"
    assert map_path.read_bytes().startswith(b"\x89PNG")
    spread_path = tmp_path / "spread.nc"
    spread = disc_model.load(spread_path)
    assert spread["growth_rate"].sizes == {"mu_k_mu_s_k_k_p": 1000}
    assert (spread["status"] == "ok").mean() > 0.9
    assert spread["multipliers_real"].sizes["multipliers_index"] > 0


STUDIES = []
for _page in PAGES:
    for _text in re.findall(
        r"^```yaml\n(.*?)^```$", _page.read_text(encoding="utf-8"), re.M | re.S
    ):
        if _text.startswith("study:"):
            STUDIES.append(pytest.param(_text, id=_page.name))


@pytest.mark.parametrize("text", STUDIES)
def test_study_files_on_pages_are_right(text: str, tmp_path: Path) -> None:
    p = Parameters(N=0, Omega=0, friction_offset="surface")
    file = tmp_path / "disc.csv"
    disc_of(p).to_csv(file)  # some of them name one
    path = tmp_path / "study.yaml"
    path.write_text(text, encoding="utf-8")
    assert load_study(path).study in text


def test_studies_of_a_page_that_show_each_other_fit(tmp_path: Path) -> None:
    """There was no example of an overlay."""
    page = next(page for page in PAGES if page.name == "critical_speed.md")
    texts = re.findall(r"^```yaml\n(study: (\w+)\n.*?)^```$", page.read_text(), re.M | re.S)
    for text, name in texts:
        (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
    grids, requested = load_study(tmp_path / "my_outcome.yaml").all_grids([tmp_path])
    assert requested == ("my_outcome",)
    assert set(grids) == {"my_outcome", "my_sliding"}


# ---- Docstrings


@pytest.mark.parametrize("name", [*disc_model.__all__, *RETURNED])
def test_examples_of_docstrings_print_what_they_say(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    runner = doctest.DocTestRunner(optionflags=OPTIONS)
    thing = resolve_name(f"disc_model.{name}")
    tests = doctest.DocTestFinder().find(thing, name, globs={})
    assert not sum(runner.run(test).failed for test in tests)
    pyplot.close("all")


PUBLIC = sorted(set(disc_model.__all__) - {"__version__"})
API = (DOCS / "api.md").read_text(encoding="utf-8")


def is_error(name: str) -> bool:
    """Return whether a public name is that of an exception."""
    value = getattr(disc_model, name)
    return isinstance(value, type) and issubclass(value, Exception)


NO_ERRORS = [name for name in PUBLIC if not is_error(name)]
FUNCTIONS = [name for name in NO_ERRORS if inspect.isfunction(getattr(disc_model, name))]


def test_everything_public_is_in_the_reference() -> None:
    listed = re.findall(r"^\.\. auto\w+:: disc_model\.(\w+)$", API, re.M)
    assert sorted(set(listed)) == PUBLIC
    assert ".. auto" not in "".join(BLOCK.findall(API)), "shown as code"


@pytest.mark.parametrize("name", NO_ERRORS)
def test_everything_public_shows_its_use(name: str) -> None:
    assert ">>> " in (getattr(disc_model, name).__doc__ or "")


@pytest.mark.parametrize("name", FUNCTIONS)
def test_public_functions_have_all_sections(name: str) -> None:
    docstring = inspect.getdoc(getattr(disc_model, name))
    sections = set(re.findall(r"^(\w+)\n---", docstring, re.M))
    assert sections >= {"Parameters", "Returns", "Raises", "Examples"}


# ---- Notebooks


def said_of_a_first_run(names: dict[str, Any]) -> None:
    run = names["run"]
    kinds = run.events["kind"]
    assert set(kinds.iloc[-40:]) == {"stick_to_slip", "slip_to_stick", "separation", "reattachment"}
    # once in each cycle of the disc, which sticks in every second one
    separations = (kinds.iloc[-1000:] == "separation").sum()
    releases = (kinds.iloc[-1000:] == "stick_to_slip").sum()
    assert abs(separations - 2 * releases) <= 2
    growth = names["growth"]
    assert (growth["growth_rate"] > 0).any()
    assert (growth["growth_rate"] < 0).any()
    assert set(growth["status"].values) == {"ok", "no_cycle"}


def test_the_universal_file_of_the_page_can_be_read(tmp_path: Path) -> None:
    page = (DOCS / "brake_disc.md").read_text(encoding="utf-8")
    [text] = re.findall(r"```text\n(    -1\n.*?)```", page, re.S)
    path = tmp_path / "modes.unv"
    path.write_text(text, encoding="utf-8")
    place = {"axis": (0, 0, 1), "centre": (0, 0, 0), "units": ("m", "N")}
    disc = disc_model.Disc.from_uff(path, "100 mm", **place)
    assert disc.diameters == (2,)
    assert math.tau * 1212 == pytest.approx(disc.omega[0], rel=1e-5)
    assert disc.damping_ratio[0] == pytest.approx(0.002)


SAID = {"first_run": said_of_a_first_run}
"""What the sentences of each notebook say of the output above them."""
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.md"))
CELL = re.compile(r"^```{code-cell}\n(?::tags:[^\n]*\n)?(.*?)^```$", re.M | re.S)


@pytest.mark.slow
@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_notebooks_show_what_they_say(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for cell in CELL.findall(page.read_text(encoding="utf-8")):
        exec(compile(cell, page.name, "exec"), names)
    pyplot.close("all")
    SAID[page.stem](names)
