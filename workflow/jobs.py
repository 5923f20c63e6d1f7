"""The jobs of the workflow: `python jobs.py NAME ARGUMENTS`, with what they compute as JSON on standard input.

Nothing is computed twice: a job takes what lies under the same content and code in its folder.
"""

import gc
import json
import logging
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import xarray as xr

from disc_model.data.dataset import load_cases, load_tree, save
from disc_model.errors import DiscModelError


def read_plan() -> Any:
    """What a rule has handed over."""
    return json.load(sys.stdin)


def save_dataset(data: xr.Dataset, path: str | Path) -> None:
    """Save a dataset as the only group of a file."""
    save(xr.DataTree(data), path)


# ---- Cases and grids


def case(output: str) -> None:
    """Simulate a named case."""
    from disc_model.simulation.case import CaseSpec
    from disc_model.simulation.named_case import run_case

    save(run_case(CaseSpec.model_validate_json(sys.stdin.read())), output)


def part(output: str) -> None:
    """Compute points of a grid, but for those that other files of the same content have."""
    _compute_part(sys.stdin.read(), Path(output))


def _compute_part(job: str, output: Path) -> xr.Dataset:
    """Compute points of a grid into a file, whose name has the hash of what they have in common first."""
    from disc_model.studies.run import run_job

    output.parent.mkdir(parents=True, exist_ok=True)
    content, _, _ = output.stem.partition("-")
    known = (load_tree(path).to_dataset() for path in sorted(output.parent.glob(f"{content}-*.nc")))
    results = run_job(job, known)
    save_dataset(results, output)
    return results


def grid(output: str, failed: str, remarked: str, folder: str) -> None:
    """Merge the parts of a grid, and list points that failed and remarks on others."""
    from disc_model.studies.run import merge, points_of, told_points

    plan = read_plan()
    parts = _parts(plan["jobs"], Path(folder))
    results = [row for part in parts for _, row in points_of(part)]
    study = merge(plan["layout"], results, plan["attrs"])
    for path, points in zip((failed, remarked), told_points(study), strict=True):
        text = "no point" if points.empty else points.to_string(index=False)
        Path(path).write_text(f"{text}\n", encoding="utf-8")
    save_dataset(study, output)


def _parts(jobs: dict[str, str], folder: Path) -> Iterator[xr.Dataset]:
    """The parts of a grid; the only one is computed here."""
    for key, job in jobs.items():
        path = folder / f"{key}.nc"
        yield load_tree(path).to_dataset() if path.exists() else _compute_part(job, path)


# ---- Figures and pages


def figure(pdf: str, png: str) -> None:
    """Draw a figure from its files by name."""
    gc.disable()  # a tenth of the time of so short a job
    from disc_model.figures.kinds import kind_of, render
    from disc_model.figures.kinds import save as save_figure

    plan = read_plan()
    shown = {name: load_tree(file, lazy=True) for name, file in plan["files"].items()}
    for name, title in plan["titles"].items():
        shown[name].attrs["title"] = title
    options = plan["plot"]
    drawn = render(kind_of(options["kind"]).model_validate(options), shown)
    for path in (png, pdf):
        save_figure(drawn, path, title=plan["caption"])


def provenance(output: str, *paths: str) -> None:
    """Write a page of all cases of a study, and what they were computed with."""
    import pandas as pd

    from disc_model.data.texts import write_page
    from disc_model.data.variables import STATUSES, values_text
    from disc_model.parameters import Parameters

    plan = read_plan()
    rows = []
    for name, case in load_cases(paths).items():
        p, values = Parameters.model_validate_json(case.attrs["parameters"]), case.to_dataset()
        rows.append(
            {
                "Case": name,
                **plan["labels"][name],
                "Parameters": f"{values_text(dict(p))}, {p.contact}, {p.normalization}",
                "Length (s)": float(values["time_reached"]),
                "First separation (s)": float(values["first_separation"]),
                "Separations": int(values["n_separations"]),
                "Outcome": STATUSES[int(values["status"])],
                "Specification": case.attrs["specification_key"],
            }
        )
    made = {"commit": case.attrs["git_commit"], "hash of the physics": case.attrs["source_hash"]}
    made |= json.loads(case.attrs["versions"])
    sources = pd.DataFrame([*made.items()], columns=["What", "Value"])
    words = "A result and the code it comes from can be told to belong together by their hashes."
    write_page(
        output, plan["title"], ("Sources", words, sources), ("Cases", "", pd.DataFrame(rows))
    )


def motions(output: str) -> None:
    """Store short histories at points of a grid, for the explorer."""
    from disc_model.studies.run import run_motions

    save_dataset(run_motions(sys.stdin.read()), output)


def explorer(output: str) -> None:
    """Write the explorer's page."""
    from disc_model.explorer import page, study_contents

    plan = read_plan()
    studies = []
    for study in plan["studies"]:
        data = load_tree(study["data"]).to_dataset()
        stored = load_tree(study["motions"]).to_dataset() if study["motions"] else None
        studies.append(study_contents(study["name"], data, stored, study["stated"]))
    Path(output).write_text(page(plan["title"], studies), encoding="utf-8")


JOBS = {job.__name__: job for job in (case, part, grid, figure, provenance, motions, explorer)}

if __name__ == "__main__":
    _, job, *arguments = sys.argv
    logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
    try:
        JOBS[job](*arguments)
    except (DiscModelError, KeyboardInterrupt) as error:
        raise SystemExit(str(error) or "interrupted") from None
