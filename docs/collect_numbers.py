"""Evaluate the numbers of README, docs and captions that come from results: `make numbers`.

The values of all expressions of `sentences` are stored as ``docs/numbers.json``, so that tests can
compare the pages with them where there are no results; then the pages are corrected. What needs
results that are not there stays as it was.
"""

from docs.sources import Sources

from disc_model.data.dataset import MissingFile
from disc_model.errors import script
from docs import sentences


def evaluated(sources: Sources) -> dict[str, sentences.Value]:
    """Return values of all expressions, the stored ones where results are missing."""
    old = sentences.stored()
    values = {}
    for expression in sorted({expression for expression, _ in sentences.expressions()}):
        try:
            values[expression] = sources.value(expression)
        except MissingFile:
            if expression not in old:
                raise
            values[expression] = old[expression]
    return values


@script
def main(results: str = "results") -> None:
    """Store the values that follow from a folder of results, and correct the pages."""
    values = evaluated(Sources(sentences.ROOT / results))
    sentences.store(values)
    for page, text in sentences.corrected(sentences.pages(), values).items():
        (sentences.ROOT / page).write_text(text, encoding="utf-8")
