"""Shades behind histories: phases of the motion, and ramps of parameters."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import Any

from matplotlib.patches import Patch

from disc_model.data.variables import PHASES, SHOWN
from disc_model.figures.drawing import GREY, PHASE_COLOURS, wide
from disc_model.figures.stated_case import Course
from disc_model.figures.types import Artist, Axes

MOST_SHADED = 60
"""Largest number of stretches of one phase that are shaded; more would be as dense as a fill."""
SHADES: dict[str, dict[str, Any]] = {
    "stick": {"color": PHASE_COLOURS["stick"], "alpha": 0.22},
    "separation": {"color": PHASE_COLOURS["separation"], "alpha": 0.5},
}
"""Behind a history, told apart by darkness in grey print; slip is left white."""
RAMPS: tuple[dict[str, Any], ...] = (
    {"facecolor": GREY, "alpha": 0.18, "linewidth": 0, "zorder": -1},
    {"facecolor": "none", "edgecolor": GREY, "hatch": 5 * "/", "linewidth": 0, "zorder": -1},
    {"facecolor": "none", "edgecolor": GREY, "hatch": 3 * ".", "linewidth": 0, "zorder": -1},
)
"""Behind a history, while a ramp goes on: of each parameter in the order of their ramps."""
MOST_RAMPS = 4
"""Largest number of ramps with an entry for each in the legend."""


def shade_phases(axes: Sequence[Axes], spans: Mapping[str, Any]) -> list[Artist]:
    """Shade phases of the motion unless these are too dense; returns entries of a legend."""
    if not 0 < max(len(spans[name]) for name in SHADES) <= MOST_SHADED:
        return []
    for name, look in SHADES.items():
        bars = [(start, stop - start) for start, stop in spans[name]]
        for ax in axes:
            whole = ax.get_xaxis_transform()
            ax.broken_barh(bars, (0, 1), transform=whole, linewidth=0, zorder=0, **look)
    return [_shade(name) for name in PHASES if spans[name]]


def _shade(phase: str) -> Artist:
    """The legend entry of a phase."""
    if phase in SHADES:
        return Patch(label=phase, **SHADES[phase])
    return Patch(label=phase, facecolor="white", edgecolor=GREY, linewidth=0.5)


def shade_ramps(axes: Sequence[Axes], ramps: Sequence[Course]) -> list[Artist]:
    """Shade the time of each ramp that is seen, between lines where it begins and ends; returns
    entries of a legend, which state its values, or one for many ramps of a parameter."""
    if len(axes) == 0:
        return []
    low, high = axes[0].get_xlim()
    ramped = dict.fromkeys(ramp.parameter for ramp in ramps)
    looks = dict(zip(ramped, cycle(RAMPS), strict=False))
    seen = [ramp for ramp in ramps if ramp.start < high and ramp.end > low]
    for ramp in seen:
        for ax in axes:
            ax.axvspan(ramp.start, ramp.end, **looks[ramp.parameter])
            for time in (ramp.start, ramp.end):
                ax.axvline(time, color=GREY, linewidth=wide(0.6), linestyle=":")
    for ax in axes:
        ax.set_xlim(low, high)
    if len(seen) > MOST_RAMPS:
        names = dict.fromkeys(ramp.parameter for ramp in seen)
        return [Patch(label=f"ramps of {SHOWN[name].symbol}", **looks[name]) for name in names]
    return [Patch(label=_ramp_text(ramp), **looks[ramp.parameter]) for ramp in seen]


def _ramp_text(ramp: Course) -> str:
    """What a legend says of a ramp."""
    shown = SHOWN[ramp.parameter]
    ends = [f"{shown.factor * value:.4g}" for value in (ramp.before, ramp.after)]
    times = f"{ramp.start:g} to {ramp.end:g} s"
    return f"{shown.symbol} from {ends[0]} to {ends[1]} {shown.unit}, {times}"
