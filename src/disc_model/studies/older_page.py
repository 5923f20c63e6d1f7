"""Whether the page of all points is older than the results that it shows, as a study's run leaves it."""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from disc_model.studies.grid import GridStudy
from disc_model.studies.study import Study

PAGE = "explorer.html"


def line_of_older_page(
    study: Study,
    grids: Mapping[str, GridStudy],
    requested: Collection[str],
    results: Path,
    command: str,
) -> str:
    """What a run says of a page that it has not made anew; "" if there is none, or a new one.

    Parameters
    ----------
    study : whose page it is
    grids : all grids of the study, also those that only figures show
    requested : names of the grids whose figures the study draws
    results : the folder of the results of all studies
    command : what makes the page
    """
    page = results / study.name / PAGE
    if not page.exists():
        return ""
    made = page.stat().st_mtime_ns
    shown = filter(Path.exists, _shown_by_page(study, grids, requested, results))
    if all(file.stat().st_mtime_ns <= made for file in shown):
        return ""
    return f"{page} is of an older state of the study; to make it anew: {command}"


def _shown_by_page(
    study: Study, grids: Mapping[str, GridStudy], requested: Collection[str], results: Path
) -> Iterator[Path]:
    """The datasets and the pictures that are on the page of a study."""
    for name in grids:
        yield results / name / f"{name}.nc"
    for owner, figure in study.entries(grids):
        if owner in (study.name, *requested):
            yield results / owner / "figures" / f"{figure}.png"
