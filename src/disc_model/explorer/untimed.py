"""Why a point has no time of its first separation: contact is kept, or the separation is not timed."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from disc_model.data.variables import Outcome, flag_names
from disc_model.figures.classes import NO_VALUE, Look
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.words import NO_VALUE as WITHOUT_VALUE

KEPT = (
    Outcome.QUIET,
    Outcome.OTHER_CYCLE,
    Outcome.STEADY_SLIDING,
    Outcome.AT_REST,
    Outcome.GROWING,
)
"""Outcomes of motions that have kept contact up to the horizon."""
LOST = (Outcome.SEPARATION, Outcome.SEPARATING)
"""Outcomes of motions that have lost it."""
OUTCOMES: Mapping[str, str] = {
    "first_separation": "outcome",
    "scan_first_separation": "scan_outcome",
}
"""Outcomes of the motions whose first separations are timed."""
CONTACT_KEPT = "contact_kept"
NOT_TIMED = "not_timed"


def classes_without_time(
    study: xr.Dataset, variable: xr.DataArray, classes: np.ndarray
) -> np.ndarray:
    """Classes of the points that have no number, where the outcomes of the study say why they have no
    time of a first separation."""
    outcome = study.get(OUTCOMES.get(str(variable.name), ""))
    if outcome is None:
        return classes
    if {*outcome.dims} != {*variable.dims} or "flag_meanings" not in outcome.attrs:
        return classes
    words = flag_names(outcome.transpose(*variable.dims))
    unvalued = classes == WITHOUT_VALUE
    found = np.where(unvalued & np.isin(words, KEPT), CONTACT_KEPT, classes)
    return np.where(unvalued & np.isin(words, LOST), NOT_TIMED, found)


def looks_without_time(study: xr.Dataset, name: str) -> Mapping[str, Look]:
    """The looks of these classes, and of points whose outcome does not say why, which differ."""
    if OUTCOMES.get(name, "") not in study:
        return {}
    unknown = missing_text(study, name)
    kept = unknown.removesuffix(", or not timed")
    return {
        CONTACT_KEPT: NO_VALUE._replace(label=kept),
        NOT_TIMED: NO_VALUE._replace(label="not timed", hatch=3 * "|"),
        WITHOUT_VALUE: NO_VALUE._replace(label=unknown, hatch=4 * "\\"),
    }
