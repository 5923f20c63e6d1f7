"""Judge the paper's conclusions under four models of disc and contact; write the page as Markdown and as HTML."""

from pathlib import Path

from disc_model.claims.survival import judge, page_of
from disc_model.data.dataset import load_inputs
from disc_model.errors import script


@script
def main(md: str, html: str, *inputs: str) -> None:
    files = [Path(file) for file in inputs]
    cases, *grids = load_inputs(files)
    found = page_of(judge(cases, {file.stem: grid.to_dataset() for file, grid in zip(files[1:], grids, strict=True)}))
    Path(md).write_text(found.markdown(), encoding="utf-8")
    Path(html).write_text(found.html(), encoding="utf-8")
