"""Checks of what is requested of a workflow and of its folder, and what a finished run says."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from disc_model.errors import DiscModelError
from disc_model.studies.grid import GridStudy
from disc_model.studies.study import Study, mapping, read_files


def check_owner(name: str, results: str, files: list[str], owner: Path) -> None:
    """Raise DiscModelError if other study files of this name have made the results, which these would overwrite.

    The same files with further ones laid over them, or without these, are the same study in other detail.

    owner : file that lists the study files of the last run
    """
    former = owner.read_text(encoding="utf-8").splitlines() if owner.exists() else files
    shorter = min(len(files), len(former))
    exist = all(Path(file).is_file() for file in former)
    if exist and former[:shorter] != files[:shorter] and mapping(read_files(*former)).get("study") == name:
        raise DiscModelError(
            f"study = {name!r}: is also the name of the study in {', '.join(former)}, whose results are in {results}"
            " and would be overwritten; give one of them another name, or another folder with --directory"
        )


def check_targets(
    targets: Iterable[str], study: Study, grids: Mapping[str, GridStudy], figures: Mapping[str, Sequence[str]]
) -> None:
    """Raise DiscModelError if a file is requested by a name that no study, figure or case has, and say which there are.

    Snakemake says no more than that no rule makes it.

    figures : names of figures, by the study in whose folder of results they are
    """
    known: Sequence[str]
    for target in targets:
        match Path(target).parts:
            case ["results", name, _, *_] if name not in (*figures, "compiled", "bench"):
                kind, wanted, known, place = "study", name, [*figures], ""
            case ["results", name, "figures", file] if name in figures:
                kind, wanted, known, place = "figure", Path(file).stem, figures[name], f" in {name}"
            case ["results", study.name, "cases", file]:
                kind, wanted, known, place = "case", Path(file).stem, [*study.specs], f" in {study.name}"
            case ["results", name, "batches", file] if name in grids:
                kind, wanted, known, place = "batch", Path(file).stem, [*grids[name].batches], ""
            case _:
                continue
        if wanted not in known:
            listed = ", ".join([*known[:50], *["..."] * (len(known) > 50)]) or "none"
            raise DiscModelError(f"{target}: there is no {kind} {wanted}{place} (known: {listed})")


def closing_lines(study: Study, figures: Sequence[Path], grids: Mapping[str, GridStudy]) -> Iterator[str]:
    """Summary of a run of a whole study: its figures, points without a result, and how to examine each point."""
    folders = {str(figure.parent) for figure in figures}
    if figures:
        folder = folders.pop() if len(folders) == 1 else "results/*/figures"
        yield f"{study.name}: {len(figures)} figure{'s' * (len(figures) > 1)} in {folder}"
    if grids:
        lists = [Path(f"results/{name}/{name}.failed.txt") for name in grids]
        failed = {file: file.read_text(encoding="utf-8").count("\n") for file in lists}
        points = sum(grid.n_points for grid in grids.values())
        reasons = ", ".join(str(file) for file, count in failed.items() if count)
        lacking = f", for others see {reasons}" if reasons else ""
        yield f"{points - sum(failed.values())} of {points} points have a result{lacking}"
        page = f"results/{study.name}/explorer.html"
        yield f"The same command with the target `explorer` makes a page of every point: {page}"
        yield "(disc-model study ... --target explorer, or snakemake ... explorer)"
