"""Values of cases and studies that stand above their figures."""

import json

import xarray as xr

from disc_model.figures.head_texts import what_case
from disc_model.figures.kinds import NORM, General, Plot
from disc_model.figures.selection import normalizations, picked
from disc_model.figures.stated_case import with_ramps
from disc_model.figures.value_texts import named_value
from disc_model.figures.varied_discs import single_disc, varied_numbers, with_frequencies
from disc_model.figures.words import MODES


def values_of_case(case: xr.DataTree) -> str:
    """The values of a recorded case, with the ramps of its drive and load."""
    values = json.loads(case.attrs.get("parameters", "{}"))
    return with_ramps(what_case(values), values, case)


def values_of_study(plot: Plot, study: xr.Dataset) -> str:
    """What a grid study does not vary, and where a figure takes what it varies but does not show."""
    texts = [*_chosen(plot, study), _stated(study), *_single_modes(plot, study)]
    return ", ".join(filter(None, texts))


def _stated(study: xr.Dataset) -> str:
    """The values of a study's base that it does not vary."""
    base = json.loads(study.attrs.get("base", "{}"))
    # 0 stands for N or Omega if the quantity varies it by itself
    by_itself = [name for name in ("N", "Omega") if not base.get(name)]
    varied = {*map(str, study.coords), *by_itself}
    kept = {name: value for name, value in base.items() if name not in varied}
    kept |= single_disc(study)
    return what_case(with_frequencies(kept, varied_numbers(*varied)))


def _single_modes(plot: Plot, study: xr.Dataset) -> list[str]:
    """The normalization of a study that has one, which no panel names."""
    modes = normalizations(study) if NORM in study.coords else []
    chosen = getattr(plot, NORM, None)
    if chosen is not None:
        modes = [chosen]
    return [MODES[modes[0]]] if len(modes) == 1 else []


def _chosen(plot: Plot, study: xr.Dataset) -> list[str]:
    """Values along dimensions of the study that a general figure takes at one place."""
    if not isinstance(plot, General):
        return []
    shown = picked(study, plot.at, *plot.axes.values())[plot.variable]
    alone = [str(name) for name, size in study.sizes.items() if size > 1 and name not in shown.dims]
    return [named_value(shown, name) for name in alone if name in shown.coords]
