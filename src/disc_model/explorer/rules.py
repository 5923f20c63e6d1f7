"""The rule of a study that leaves points out, as its page says it."""

import xarray as xr

BETWEEN = ") and ("


def rule_of(study: xr.Dataset) -> str:
    """The rule, without the brackets of a single one; "" for a study without."""
    rule = str(study.attrs.get("where", ""))
    if BETWEEN in rule:
        return rule
    return rule.removeprefix("(").removesuffix(")")
