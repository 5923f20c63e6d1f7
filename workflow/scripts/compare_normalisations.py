"""Set the cases of both normalisations beside each other, as Markdown and as a page."""

from pathlib import Path

from disc_model.data.dataset import load_inputs
from disc_model.data.texts import write_page
from disc_model.errors import script
from disc_model.paper.measures import views
from disc_model.paper.normalisation import TEXTS, compare


@script
def main(md: str, html: str, published: str, orthonormal: str) -> None:
    models = load_inputs([Path(published), Path(orthonormal)])
    sections = compare(*(views({"cases": cases}) for cases in models))
    for file in (md, html):
        write_page(file, TEXTS["title"], *sections)
