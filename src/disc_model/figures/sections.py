"""When samples of motions were taken, in words of figures."""

import xarray as xr

from disc_model.data.variables import stated_in

ONCE_A_TURN = "once per turn of the drive"
EVENTS = {"stick": "at release of stick", "separation": "at loss of contact"}
"""Names of the phases at whose beginning or end samples are taken."""


def names_of_events(study: xr.Dataset) -> dict[str, str]:
    """The names of events at which samples were taken, by the phases there; none if they were taken once
    per turn."""
    return EVENTS if _section(study) == "event" else {}


def with_section(study: xr.Dataset, name: str, words: str) -> str:
    """The words for a variable of a study, with when it was sampled if that is once per turn; events are
    named by the marks of their samples."""
    sampled = name in study and "sample" in study[name].dims
    if sampled and _section(study) == "stroboscopic":
        return f"{words} {ONCE_A_TURN}"
    return words


def _section(study: xr.Dataset) -> str:
    """When samples were taken, as the options of a study state it; "" without any."""
    return str(stated_in(study, "options").get("section", ""))
