"""The examples of docs/ and of the README do what they say, and everything public has one."""

import doctest
import inspect
import re
from pathlib import Path
from pkgutil import resolve_name

import pytest
from matplotlib import pyplot

import disc_model
from disc_model import Parameters
from disc_model.disc import plausibility
from disc_model.studies.study import load_study
from tests.disc.table import disc_table

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    {*(ROOT / "docs").glob("*.md"), *(ROOT / "docs").glob("howto/*.md"), ROOT / "README.md"}
)
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)
WITH_EXAMPLES = [page for page in PAGES if ">>>" in page.read_text(encoding="utf-8")]


def blocks(page):
    return BLOCK.findall(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", WITH_EXAMPLES, ids=lambda page: page.name)
def test_examples_print_what_they_say(page, tmp_path, monkeypatch):
    """A page is one session."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "config").symlink_to(ROOT / "config")
    test = doctest.DocTestParser().get_doctest("\n".join(blocks(page)), {}, page.name, str(page), 0)
    outcome = doctest.DocTestRunner(
        optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    ).run(test)
    assert outcome.attempted > 0
    assert outcome.failed == 0


#: Classes of what functions return, whose methods draw, and those that others have them from.
RETURNED = [
    "mode_choice.ModeChoice",
    "simulation.pictures.Pictures",
    "stability.continuation.Branch",
    "display.Drawn",
]


@pytest.mark.parametrize("name", [*disc_model.__all__, *RETURNED])
def test_examples_of_docstrings_print_what_they_say(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plausibility, "_reported", set())  # each doubt is told once in a process
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    tests = doctest.DocTestFinder().find(resolve_name(f"disc_model.{name}"), name, globs={})
    assert not sum(runner.run(test).failed for test in tests)
    pyplot.close("all")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_example_is_in_a_block_that_is_run(page):
    text = page.read_text(encoding="utf-8")
    assert text.count(">>> ") == sum(block.count(">>> ") for block in blocks(page))


#: What the sentences of each notebook say of the output above them.
SAID = {
    "first_run": (
        "set(run.events['kind'].iloc[-40:]) == {'stick_to_slip', 'slip_to_stick', 'separation', 'reattachment'}",
        "abs((run.events['kind'].iloc[-1000:] == 'separation').sum() - 2 * (run.events['kind'].iloc[-1000:] == "
        "'stick_to_slip').sum()) <= 2",  # once in each cycle of the disc, which sticks in every second one
        "axes[0, 1].get_xlim()[1] == 60 and run['late']['P'].attrs['units'] == 'N'",
        "dm.floquet(case.replace(Omega=15)).stable",
        "(growth['growth_rate'] > 0).any() and (growth['growth_rate'] < 0).any()",
        "set(growth['status'].values) == {'ok', 'no_cycle'}",
    ),
    "reading_results": (
        "list(tree.children) == ['events', 'history', 'final_state']",
        "len(named) > 3 and sum('f_s' in name or 'f_Ω' in name for name in named) == len(named)",
    ),
    "brake_disc": (
        "len(disc.omega) == 7 and max(disc.omega) < math.tau * 3000",
        "sum(dm.steady_sliding(case).eigenvalues.real > 0) == 2 * 3",
        "round(abs(dm.steady_sliding(case).eigenvalues[0]) / math.tau) == 1769",
        "dm.steady_sliding(middle).stable and math.isnan(dm.simulate(middle, 60).first_separation)",
        "(growth.Omega[growth['growth_rate'] > 0].min(), growth.Omega[growth['growth_rate'] > 0].max()) == (17, 25)",
        "set(growth['status'].values[growth.Omega > 25]) == {'no_stick_slip'}",
        "abs(run.first_separation - 1 / 3) < 0.01 and run.statistics['surface_speed'] < 1",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", sorted((ROOT / "docs" / "notebooks").glob("*.md")), ids=lambda page: page.stem
)
def test_notebooks_show_what_they_say(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    assert text.count("\n") <= 90, "a screen and a half"
    names = {}
    for cell in re.findall(r"^```{code-cell}\n(?::tags:[^\n]*\n)?(.*?)^```$", text, re.M | re.S):
        exec(compile(cell, page.name, "exec"), names)
    pyplot.close("all")
    assert [fact for fact in SAID[page.stem] if not eval(fact, names)] == []


def test_everything_public_is_in_the_reference_and_shows_its_use():
    text = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    assert ".. auto" not in "".join(re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S)), (
        "shown as code"
    )
    listed = set(re.findall(r"^\.\. auto\w+:: disc_model\.(\w+)$", text, re.M))
    assert listed == set(disc_model.__all__) - {"__version__"}
    values = {name: getattr(disc_model, name) for name in listed}
    errors = {
        name
        for name, value in values.items()
        if isinstance(value, type) and issubclass(value, Exception)
    }
    for name in sorted(
        listed - errors
    ):  # the table for those who read the page in a repository's browser
        paragraph = " ".join((inspect.getdoc(values[name]) or "").split("\n\n")[0].split())
        assert f"| `{name}` | {re.split(r'(?<!Eq[.])(?<=[.]) ', paragraph)[0]} |" in text
    assert not [name for name in listed - errors if ">>> " not in (values[name].__doc__ or "")]
    for name in sorted(listed - errors):
        if inspect.isfunction(values[name]):
            sections = re.findall(r"^(\w+)\n---", inspect.getdoc(values[name]), re.M)
            assert {"Parameters", "Returns", "Raises", "Examples"} <= {*sections}, name
    drawing = [
        member for name in RETURNED for member in vars(resolve_name(f"disc_model.{name}")).values()
    ]
    drawing = [
        member
        for member in drawing
        if getattr(member, "__name__", "").startswith(("plot", "animate"))
    ]
    assert len(drawing) == 7
    for word in (">>> ", "Returns|returns", "Raises|raises"):
        assert not [
            member.__qualname__ for member in drawing if not re.search(word, member.__doc__)
        ], word


STUDIES = [
    (page.name, text)
    for page in PAGES
    for text in re.findall(r"^```yaml\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)
    if text.startswith("study:")
]


@pytest.mark.parametrize("text", [text for _, text in STUDIES], ids=[name for name, _ in STUDIES])
def test_study_files_on_pages_are_right(text, tmp_path):
    disc = disc_table(Parameters(N=0, Omega=0, friction_offset="surface"))  # some of them name one
    (tmp_path / "disc.csv").write_text(disc)
    path = tmp_path / "study.yaml"
    path.write_text(text, encoding="utf-8")
    assert load_study(path).name in text
