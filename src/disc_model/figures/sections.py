"""When samples of motions were taken, in words of figures."""

import xarray as xr

from disc_model.data.variables import flag_names, stated_in

ONCE_A_TURN = "once per turn of the drive"
EVENTS = {"stick": "at release of stick", "separation": "at loss of contact"}
"""Names of the phases at whose beginning or end samples are taken."""


def names_of_events(study: xr.Dataset) -> dict[str, str]:
    """The names of events at which samples were taken, by the phases there; none if they were taken once
    per turn."""
    return EVENTS if _section(study) == "event" else {}


def is_once_a_turn(study: xr.Dataset) -> bool:
    """Whether samples were taken once per turn of the drive."""
    return _section(study) == "stroboscopic"


def with_section(study: xr.Dataset, name: str, words: str) -> str:
    """The words for a variable of a study, with when it was sampled if that is once per turn, or at the
    event of a single motion; those of several are named by the marks of their samples."""
    sampled = name in study and "sample" in study[name].dims
    if sampled and is_once_a_turn(study):
        return f"{words} {ONCE_A_TURN}"
    if sampled:
        return f"{words} {_only_event(study)}".rstrip()
    return words


def _only_event(study: xr.Dataset) -> str:
    """The name of the event at which a single motion was sampled; "" of several motions."""
    phases = study.get("phase")
    if phases is None or "sample" not in phases.dims or phases.size > phases.sizes["sample"]:
        return ""
    names = names_of_events(study)
    found = [name for phase, name in names.items() if (flag_names(phases) == phase).any()]
    return found[0] if len(found) == 1 else ""


def _section(study: xr.Dataset) -> str:
    """When samples were taken, as the options of a study state it; "" without any."""
    return str(stated_in(study, "options").get("section", ""))
