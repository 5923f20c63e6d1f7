"""How curves show motions that are sampled after a transient, as the figures do: marks of the phases of
samples, and a strip of kinds of motion."""

from typing import Any

import xarray as xr

from disc_model.figures.bifurcation_samples import MARKS, RINGS, UNDECIDED, UNDECIDED_NAME
from disc_model.figures.classes import UNSETTLED, name_of
from disc_model.figures.kind_rows import FILLED, SHAPES, words_of_kinds
from disc_model.figures.sections import names_of_events


def marks_of_samples(study: xr.Dataset) -> list[dict[str, Any]]:
    """The marks of samples by their phase, where motions have settled and where that is not shown; none of
    a study without samples."""
    if not {"phase", "settled"} <= {*study} or "sample" not in study["phase"].dims:
        return []
    names = names_of_events(study)
    found = []
    for phase, look in MARKS.items():
        label = names.get(phase, phase)
        doubtful = UNDECIDED_NAME
        if phase in names:
            doubtful = f"{label}, {UNSETTLED.label}"
        found.append(
            {
                "phase": phase,
                "label": label,
                "shape": look["marker"],
                "unsettled": doubtful,
                "ring": RINGS.get(phase, UNDECIDED["marker"]) if names else UNDECIDED["marker"],
            }
        )
    return found


def strip_of_kinds(study: xr.Dataset) -> dict[str, Any] | None:
    """What the strip of kinds of motion is called, and the mark of each kind; None for a study whose
    points have none."""
    if not {"kind", "settled"} <= {*study} or study["kind"].dims != study["settled"].dims:
        return None
    marks = []
    for kind, shape in SHAPES.items():
        marks.append(
            {"kind": kind, "label": name_of(kind), "shape": shape, "is_filled": kind in FILLED}
        )
    return {"title": f"on the grey strip: {words_of_kinds(study)}", "marks": marks}
