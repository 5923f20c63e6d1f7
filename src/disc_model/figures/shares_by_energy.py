"""Shares of the starts of each energy that separate, over a parameter: a line for each energy."""

import xarray as xr

from disc_model.figures.basin_shares import OF_ENERGY
from disc_model.figures.kinds.motions import ENERGY
from disc_model.figures.separating_share import SEPARATING, SHARE, interval_of

OF_LINES = f'or draw a line for each energy by lines="{ENERGY}"'
"""What else a reader may do who asks for all shares of all energies at once."""
BESIDE = ("status", "message", "kind")
"""Variables that say of which points, and of which starts, something is known."""
LONG_NAME = "share of the starts that separate"


def asks_for_lines(study: xr.Dataset, variable: str, lines: str | None) -> bool:
    """Whether shares of each energy are asked for as lines, and not as bars."""
    return variable == OF_ENERGY and variable in study and bool(lines)


def with_separating_shares(study: xr.Dataset) -> xr.Dataset:
    """A study of starts with the share of each energy that separates, and its interval, as variables
    of their own in place of the shares of all outcomes."""
    separating = study[OF_ENERGY].sel(attractor_class=SEPARATING, drop=True)
    shares = {SHARE: separating.assign_attrs(long_name=LONG_NAME, units="1")}
    interval = interval_of(study, OF_ENERGY)
    if interval is not None:
        for end in ("low", "high"):
            shares[f"{SHARE}_{end}"] = interval[f"{OF_ENERGY}_{end}"]
    beside = study[[name for name in BESIDE if name in study]]
    return beside.assign(shares)
