"""Print the page of all options of quantities, from the models that check them: `make schema`."""

from collections.abc import Sequence

from disc_model.studies.options import Option, options_of
from disc_model.studies.registry import quantity_names, quantity_of

HEAD = """\
# Options of quantities

All keys under `options` of a study file, by [quantity](study_quantities.md). *Required* ones have no default. Numbers
may have [units](study_reference.md#axes). A range such as `{start: 5, stop: 50, count: 10}` has `step` or `count`.
[Starts](study_reference.md#starts) explains `prerun` and `perturbation`, [sensitivity](study_quantities.md#sensitivity)
`distributions`. In Python, `dm.run_study` takes them as here; functions of a case, such as `dm.outcome`, have
[arguments](api.md) of their own.
"""
HEADS = ("option", "given as", "default", "meaning")


def page_text() -> str:
    """The page: a table of the options of each quantity, as Markdown."""
    sections = []
    for name in quantity_names():
        rows = [_cells(option) for option in options_of(quantity_of(name))]
        lines = [HEADS, ["---"] * len(HEADS), *rows]
        sections.append(f"\n## {name}\n\n{''.join(map(_line, lines))}")
    return HEAD + "".join(sections)


def _line(cells: Sequence[str]) -> str:
    """A line of a table."""
    return f"| {' | '.join(cells)} |\n"


def _cells(option: Option) -> list[str]:
    """The cells of an option."""
    form = option.form
    if option.unit:
        form += f" in {option.unit.replace('that of', 'the unit of')}"
    default = f"`{option.default}`" if option.default else ""
    default = "*required*" if option.default == "required" else default
    return [f"`{option.name}`", form, default, option.meaning]


if __name__ == "__main__":
    print(page_text(), end="")
