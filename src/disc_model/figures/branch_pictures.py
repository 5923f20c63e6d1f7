"""All branches of a sweep on the same axes."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from disc_model.data.swept_branches import OF_SWEEPS, has_failed, is_of_sweep, points_of_sweep
from disc_model.display import draw
from disc_model.errors import Fault, ParameterError, require

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def plot_branches(
    swept: xr.Dataset,
    y: str = "growth_rate",
    *,
    ax: Axes | None = None,
    legend: bool | dict[str, Any] = True,
    labels: dict[str, str] | None = None,
    title: str | bool | None = None,
    looks: dict[str, dict[str, Any]] | None = None,
    units: dict[str, str] | None = None,
) -> Axes:
    """Draw all branches of a sweep of `continue_cycle` on the same axes, as `Branch.plot` draws one.

    The legend names them by what varies. Points that have failed have no branch: the legend and a warning
    name them, and ``swept["message"]`` says why.

    Parameters
    ----------
    swept : what ``sweep(continue_cycle, ...)`` returns, or a selection of it
    y : growth_rate, period, stick_fraction, range, u_min or u_max, as in `Branch.plot`
    ax, legend, labels, title : as in `Result.plot`
    looks : as in `Branch.plot`, such as ``{"stable": {"linestyle": "-"}, "unstable": {"linestyle": "--"}}``
    units : as in `plot_sweep`, such as ``{"Omega": "rpm"}``

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or no point has a branch.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=14.9)
    >>> swept = dm.sweep(dm.continue_cycle, case, name="Omega", bounds=(14.8, 15.2), N=[300, 385])
    >>> dm.plot_branches(swept, "period").get_ylabel()
    'Period of the cycle (ms)'
    """
    from disc_model.figures.drawn_units import drawn_in

    _refuse_others(swept)
    with drawn_in(swept, units) as shown:
        return _plot(shown, y, ax, labels, legend=legend, title=title, looks=looks)


def _plot(
    swept: xr.Dataset, y: str, ax: Axes | None, labels: dict[str, str] | None, **options: Any
) -> Axes:
    """Draw all branches of a sweep, whose coordinates are in SI."""
    from disc_model.stability.continuation import Branch

    points = [*points_of_sweep(swept)]
    whole = [point for point in points if not has_failed(point)]
    failed = [_name_of(point, swept) for point in points if has_failed(point)]
    *before, last = whole
    for point in before:
        named = _with_name(point, swept, labels)
        ax = Branch.from_dataset(point).plot(y, ax=ax, labels=named, **options)
    named = _with_name(last, swept, labels)
    further: dict[str, Any] = {"labels": named, "failed": failed}
    axes = draw("plot_branch", Branch.from_dataset(last), y, ax=ax, **options, **further)
    if failed:
        why = 'swept["message"] says why'
        warnings.warn(f"no branch at {'; '.join(failed)}: {why}", stacklevel=3)
    return axes


def _refuse_others(swept: Any) -> None:
    """Raise `ParameterError` for what is no sweep of branches, or has none."""
    has_points = hasattr(swept, "variables") and OF_SWEEPS.issubset(swept.variables)
    if has_points and swept["status"].size and (swept["status"] == "failed").all():
        message = swept["message"].values.flat[0]
        rule = f"must have a branch, but all of its points failed, the first with {message}"
        raise ParameterError(Fault(("swept",), "", rule))
    require((is_of_sweep(swept), "swept", swept, "must be a sweep of continue_cycle"))


def _varying(swept: xr.Dataset) -> list[str]:
    """The names of what varies between the points of a sweep."""
    along = {*swept["status"].dims}
    return [str(name) for name, values in swept.coords.items() if along & {*values.dims}]


def _name_of(point: xr.Dataset, swept: xr.Dataset) -> str:
    """What sets a point apart from others, in words."""
    from disc_model.figures.value_texts import stated_value

    return ", ".join(stated_value(name, point[name].item()) for name in _varying(swept))


def _with_name(
    point: xr.Dataset, swept: xr.Dataset, labels: dict[str, str] | None
) -> dict[str, str] | None:
    """The labels of a branch, with its name where its case does not tell what varies."""
    from disc_model.parameters import Parameters

    told_by_case = {*_varying(swept)} <= {*Parameters.model_fields}
    if told_by_case or not isinstance(labels or {}, dict):
        return labels
    return {"branch": _name_of(point, swept), **(labels or {})}
