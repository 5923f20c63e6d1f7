"""Judge the paper's conclusions under four models of disc and contact; write the page as Markdown and as HTML."""

from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from disc_model.paper.measures import views
from disc_model.paper.survival import TEXTS, page_of


@script
def main(md: str, html: str, *inputs: str) -> None:
    sections = page_of(views(load_cases([*map(Path, inputs)])))
    for file in (md, html):
        write_page(file, TEXTS["title"], *sections)
