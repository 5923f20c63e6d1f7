"""Print the page of all options of quantities, from the models that check them: `make schema`."""

from disc_model.studies.options import Option, options_of
from disc_model.studies.registry import quantity_names, quantity_of

HEAD = """\
# Options of quantities

All keys under `options` of a study file, by [quantity](study_quantities.md). *Required* ones have no default. Numbers
may have [units](study_reference.md#axes). A range such as `{start: 5, stop: 50, count: 10}` has `step` or `count`.
[Starts](study_reference.md#starts) explains `prerun` and `perturbation`, [sensitivity](study_quantities.md#sensitivity)
`distributions`. `disc-model study my.yaml -n` shows the options of a study with their values.
"""
TABLE = """\
| option | given as | default | meaning |
| --- | --- | --- | --- |
"""


def page_text() -> str:
    """The page: a table of the options of each quantity, as Markdown."""
    sections = []
    for name in quantity_names():
        rows = map(_row, options_of(quantity_of(name)))
        sections.append(f"\n## {name}\n\n{TABLE}{''.join(rows)}")
    return HEAD + "".join(sections)


def _row(option: Option) -> str:
    form = option.form
    if option.unit:
        form += f" in {option.unit.replace('that of', 'the unit of')}"
    default = f"`{option.default}`" if option.default else ""
    default = "*required*" if option.default == "required" else default
    return f"| {' | '.join((f'`{option.name}`', form, default, option.meaning))} |\n"


if __name__ == "__main__":
    print(page_text(), end="")
