"""Set the cases of both normalisations beside each other, as Markdown and as a page."""

from pathlib import Path

from disc_model.data.dataset import load_inputs
from disc_model.errors import script
from disc_model.paper.ledger import compare


@script
def main(md: str, html: str, published: str, orthonormal: str) -> None:
    found = compare(*load_inputs([Path(published), Path(orthonormal)]))
    Path(md).write_text(found.markdown(), encoding="utf-8")
    Path(html).write_text(found.html(), encoding="utf-8")
