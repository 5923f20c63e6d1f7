"""Draw one figure: the plot as its kind describes it, titles of its cases by name, and the title of
the files, as JSON; inputs as name=file."""

import json

from disc_model.data.dataset import load_result
from disc_model.errors import script
from disc_model.figures.kinds import kind_of, render, save


@script
def main(plot: str, titles: str, title: str, pdf: str, png: str, *inputs: str) -> None:
    options = json.loads(plot)
    names, _, files = zip(*(pair.partition("=") for pair in inputs), strict=True)
    shown = dict(zip(names, map(load_result, files), strict=True))
    for name, text in json.loads(titles).items():
        shown[name].attrs["title"] = text
    figure = render(kind_of(options["kind"]).model_validate(options), shown)
    for path in (png, pdf):
        save(figure, path, title=json.loads(title))
