"""Bifurcation diagrams, with the largest Lyapunov exponent below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import Bifurcation
from disc_model.figures.parts import BLACK, BLUE, GREY, ORANGE, PAGE, PHASE_COLOURS, VERMILION, new_figure, styled


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Bifurcation) -> Figure:
    """The figure of a study of the quantity `bifurcation`; others: ``lyapunov`` of that quantity over the same axis."""
    norm = parts.normalizations(study)[0]
    study = parts.of(study, norm)
    went_well = ~parts.failed(study)
    study = study.assign(phase=(study["phase"].astype(int) - 1).where(went_well, -1))
    idle = study[plot.x].values[((study["phase"] == -1).all("sample") & went_well).values]
    exponents = None
    if "lyapunov" in others:
        exponents = parts.without_failed(parts.of(others["lyapunov"], norm), "exponent", "exponent_error")
    return bifurcation_diagram(study, plot.x, plot.variable, plot.scale, exponents, idle)


@styled
def bifurcation_diagram(
    samples: xr.Dataset,
    name: str,
    variable: str = "psi",
    scale: float = 1e3,
    lyapunov: xr.Dataset | None = None,
    idle: Sequence[float] | NDArray[np.float64] = (),
) -> Figure:
    """Samples against a parameter; those in stick apart from those in slip or separation, and grey where the motion
    was not steady yet.

    Where all samples or the largest exponent are missing, a cross says so.

    samples : as `disc_model.stability.bifurcation.bifurcation_samples` returns; name : its parameter's dimension
    scale : factor for the axis, 1e3 shows mrad or mm
    lyapunov : `exponent` and `exponent_error` (1/s) over the parameter and `exponent_number`, for a panel below
    idle : values at which the motion has nothing to sample, as no switches; no failure
    """
    figure = new_figure(PAGE, 2.6 if lyapunov is None else 4.0)
    axes = figure.subplots(1 if lyapunov is None else 2, 1, sharex=True, squeeze=False)[:, 0]
    ax = axes[0]
    values = samples[variable].transpose(name, "sample")
    phase = samples["phase"].transpose(name, "sample").values
    label, factor = parts.axis_of(name)
    along = values[name].values * factor
    position = np.broadcast_to(along[:, None], values.shape)
    unsteady = np.zeros(phase.shape, dtype=bool)
    if "steady" in samples:
        unsteady[:] = (flag_names(samples["steady"].transpose(name)) == "no")[:, None]
    if (there := unsteady & (phase >= 0)).any():
        shown = values.values[there] * scale
        ax.plot(position[there], shown, ".", color=GREY, markersize=1.5, alpha=0.5, label="not steady")
    for code, (name_of_phase, color) in enumerate(PHASE_COLOURS.items()):
        here = (phase == code) & ~unsteady
        if np.any(here):
            ax.plot(position[here], values.values[here] * scale, ".", color=color, markersize=1.5, label=name_of_phase)
    none = (phase == -1).all(axis=1)
    still = none & np.isin(values[name].values, idle)
    parts.mark_failed(ax, along[none & ~still])
    if still.any():
        low = np.full(int(still.sum()), 0.02)
        ax.plot(
            along[still], low, "|", color=GREY, markersize=4, transform=ax.get_xaxis_transform(), label="no switches"
        )
    unit = values.attrs.get("units", "")
    prefix = {1e3: "m", 1.0: "", 1e6: "µ"}.get(scale, f"{1 / scale:g} ")
    axes[-1].set_xlabel(label)
    ax.set_ylabel(f"{parts.MOTION[variable]} ({prefix}{unit.replace(' s-1', '/s')})")
    if lyapunov is not None:
        _exponents(axes[1], lyapunov, name)
    legend = ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=4, borderaxespad=0.2)
    for handle in legend.legend_handles:  # dots of the diagram are too small for it
        if isinstance(handle, Line2D):
            handle.set_markersize(6)
    return figure


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """The largest exponents with four standard errors; rings where they have not converged."""
    exponent = lyapunov["exponent"].transpose("exponent_number", name)
    error = lyapunov["exponent_error"].transpose("exponent_number", name)
    along = exponent[name].values * parts.axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    for i, color in zip(range(len(exponent)), (VERMILION, BLUE, ORANGE, BLACK), strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        low, high = (exponent[i].values + s * 4 * error[i].values for s in (-1, 1))
        ax.plot(along, exponent[i], ".-", color=color, markersize=3, linewidth=0.8, label=label)
        ax.fill_between(along, low, high, color=color, alpha=0.15, linewidth=0)
    if "converged" in lyapunov:
        moving = (flag_names(lyapunov["converged"].transpose("exponent_number", name)) == "no") & np.isfinite(exponent)
        at = np.broadcast_to(along, moving.shape)
        if moving.any():
            ax.plot(
                at[moving], exponent.values[moving], "o", color=BLACK, markerfacecolor="none", markersize=4,
                markeredgewidth=0.6, label="not converged",
            )  # fmt: skip
    parts.mark_failed(ax, along[np.isnan(exponent[0].values)])
    ax.set_ylabel("Lyapunov exponents" + (",\ntrivial one left out" if "along" in lyapunov else "") + " (1/s)")
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=4, borderaxespad=0.2)
