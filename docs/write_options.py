"""Print the page of all options of quantities, from the models that check them: `make schema`."""

from disc_model.studies.options import Option, options_of
from disc_model.studies.registry import quantity_names, quantity_of

HEAD = """\
# Options of quantities

All keys under `options` of a study file, by [quantity](study_quantities.md). *Required* ones have no default. Numbers
may have [units](study_reference.md#axes). A range such as `{start: 5, stop: 50, count: 10}` has `step` or `count`.
[Starts](study_reference.md#starts) explains `prerun` and `perturbation`, [sensitivity](study_quantities.md#sensitivity)
`distributions`. `disc-model study my.yaml -n` shows the options of a study with their values.

| quantity | option | given as | unit | default | meaning |
| --- | --- | --- | --- | --- | --- |
"""


def page_text() -> str:
    """The page: a table of all options, as Markdown."""
    rows = []
    for name in quantity_names():
        options = options_of(quantity_of(name))
        heads = [f"`{name}`", *[""] * (len(options) - 1)]
        rows += [_row(head, option) for head, option in zip(heads, options, strict=True)]
    return HEAD + "".join(rows)


def _row(head: str, option: Option) -> str:
    default = f"`{option.default}`" if option.default else ""
    default = "*required*" if option.default == "required" else default
    cells = (head, f"`{option.name}`", option.form, option.unit, default, option.meaning)
    return f"| {' | '.join(cells)} |\n"


if __name__ == "__main__":
    print(page_text(), end="")
