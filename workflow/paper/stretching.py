"""What a plate that stretches makes of motions that separate on the linear plate: words for rows of the ledger."""

import math
from collections.abc import Iterable, Iterator, Mapping

import xarray as xr

from disc_model.data.variables import stated_in
from disc_model.parameters import Parameters
from workflow.paper.measures import CaseView

STUDY = "stretching_motions"
SETTLED = 0.02
"""Share by which the range of a settled motion may differ from that at three quarters of the time."""


def with_stretching(cases: Iterable[CaseView], study: xr.Dataset) -> str:
    """Return what motions of cases with separation come to if the plate stretches; empty where none
    of them is in the study.

    Parameters
    ----------
    cases : of a row
    study : `range_law` of motions in contact and with separation, with and without stretching
    """
    known = dict(motions(study))
    words = {}
    for case in cases:
        if not case.is_grid and case.parameters in known:
            words[case.place] = words_of(known[case.parameters])
    return "; ".join(f"{place}: {each}" for place, each in words.items())


def motions(study: xr.Dataset) -> Iterator[tuple[Parameters, Mapping[str, xr.Dataset]]]:
    """Yield the linear case of each motion of the study, and its motions on a plate that stretches, by
    their starts."""
    (along,) = study["N"].dims
    base = stated_in(study, "base")
    stretched = study.sel(stretching="clamped")
    for i in range(study.sizes[along]):
        point = stretched.isel({along: i})
        names = [name for name in point.coords if name in Parameters.model_fields]
        values = {str(name): point[name].item() for name in names}
        case = Parameters.model_validate(base | values | {"stretching": "none"})
        yield case, {str(begin): point.sel(begin=begin) for begin in point["begin"].values}


def words_of(begins: Mapping[str, xr.Dataset]) -> str:
    """Return what a motion from rest comes to, and whether one after a blow goes on separating."""
    rest = begins["static"]
    first = float(rest["first_separation"])
    text = f"separates at {first:.4g} s" if math.isfinite(first) else "no separation in 300 s"
    text += f", range {1e3 * float(rest['range']):.3g} mm in the end"
    change = abs(float(rest["range"] - rest["earlier_range"]))
    if not change <= SETTLED * float(rest["range"]):
        text += " (not settled)"
    if begins["displaced"]["separation_rate"] > 0 and not rest["separation_rate"] > 0:
        text += ", but after a blow of 5 m/s it goes on separating"
    return text
