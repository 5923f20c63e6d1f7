"""Judge the paper's conclusions under four models of disc and contact; write the page as Markdown and as HTML."""

from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.errors import script
from disc_model.paper.survival import judge, page_of


@script
def main(md: str, html: str, *inputs: str) -> None:
    grids = load_cases([*map(Path, inputs)])
    cases = grids.pop("cases")
    found = page_of(judge(cases, {name: grid.to_dataset() for name, grid in grids.items()}))
    Path(md).write_text(found.markdown(), encoding="utf-8")
    Path(html).write_text(found.html(), encoding="utf-8")
