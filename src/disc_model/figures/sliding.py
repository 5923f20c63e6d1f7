"""Complex eigenvalues: modes of steady sliding along a parameter, root loci, and what the motion really does."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.campbell import colour_of, mode_handles
from disc_model.figures.cells import Look, edges_of, fill, patches
from disc_model.figures.drawing import BLACK, GREY, PAGE, Figure, panels
from disc_model.figures.kind import Plot, Role, Roles
from disc_model.units import Positive, Unit

THIN, THICK = 0.8, 2.4
"""Widths of the lines of modes that decay and grow."""
ROUNDING = 1e-9
"""1/s, growth rates of undamped modes by rounding."""


def modes_of(study: xr.Dataset) -> Iterator[tuple[int, xr.Dataset]]:
    """Each mode of a study of one point, with its nodal diameters at the first value; -1 in the plane."""
    for _, mode in study.groupby("mode"):
        mode = mode.squeeze("mode")
        known = np.isfinite(mode["frequency"].values)
        if known.any():
            yield int(mode["diameters"].values[known.argmax()]), mode


class SlidingModes(Plot):
    """Frequencies and growth rates of steady sliding's modes along a parameter; where two meet, they coalesce.

    highest : Hz, highest frequency shown
    """

    quantities = ("sliding",)

    kind: Literal["sliding_modes"] = "sliding_modes"
    highest: Annotated[Positive, Unit("Hz")] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw (a) frequencies, (b) growth rates, by nodal diameters; thick where a mode grows."""
        study = study.squeeze()
        label, factor = drawing.label_of(study["value"])
        along = study["value"].values * factor
        figure, [top, bottom] = panels(PAGE, 5.2, 2, height_ratios=[3, 2], sharex=True)
        for l, mode in modes_of(study):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            for ax, values in ((top, frequency), (bottom, rate)):
                ax.plot(along, values, color=colour_of(l), linewidth=THIN)
                x, y = (np.where(rate > ROUNDING, coordinates, np.nan) for coordinates in (along, values))
                ax.plot(x, y, ".-", color=colour_of(l), linewidth=THICK, markersize=3)
        bottom.axhline(0, color=BLACK, linewidth=0.5)
        top.set(ylabel="Frequency in the slider's frame (Hz)", xlim=(along[0], along[-1]))
        if self.highest is not None:
            top.set_ylim(0, self.highest)
        # the sign matters: decay of high modes may be much faster
        low, high = (float(end(study["mode_growth_rate"])) for end in (np.nanmin, np.nanmax))
        bottom.set(
            xlabel=label, ylabel="Growth rate (1/s)", ylim=(max(1.1 * low, -2 * max(high, 0.1)), 1.1 * max(high, 0.1))
        )
        drawing.letters([top, bottom])
        grows = drawing.sample(color=GREY, linewidth=THICK, label="grows")
        handles = [*mode_handles(l for l, _ in modes_of(study)), grows]
        figure.legend(handles=handles, loc="outside lower center", ncols=7)
        return figure


class RootLocus(Plot):
    """Eigenvalues of steady sliding in the plane of growth rate and frequency, coloured along the parameter."""

    quantities = ("sliding",)

    kind: Literal["root_locus"] = "root_locus"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a line for each mode, with an open mark where it begins."""
        from cmcrameri import cm

        study = study.squeeze()
        label, factor = drawing.label_of(study["value"])
        along = study["value"].values * factor
        figure, [ax] = panels(PAGE, 3.8)
        for l, mode in modes_of(study):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            ax.plot(rate, frequency, color=colour_of(l), linewidth=THIN, zorder=1)
            ax.plot(rate[:1], frequency[:1], "o", color=colour_of(l), markersize=4, markerfacecolor="white")
            points = ax.scatter(rate, frequency, c=along, cmap=cm.batlow, vmin=along[0], vmax=along[-1], s=5, zorder=2)
        ax.axvline(0, color=BLACK, linewidth=0.6)
        ax.set(xlabel="Growth rate (1/s)", ylabel="Frequency in the slider's frame (Hz)")
        figure.colorbar(points, ax=ax, label=label, pad=0.01, aspect=30)
        figure.legend(handles=mode_handles(l for l, _ in modes_of(study)), loc="outside lower center", ncols=7)
        return figure


AGREEMENTS = {
    "stable_quiet": Look("stable, and the motion quiet", "#f3f6f8"),
    "stable_grows": Look("stable, but the motion leaves the quiet cycle in contact", "#86a0b8"),
    "stable_separates": Look("stable, but the motion separates", "#2b4f74", 3 * "x"),
    "unstable_quiet": Look("unstable, but the motion stays quiet", "#f2c14e", 3 * "."),
    "unstable_grows": Look("unstable, and the motion grows in contact", "#e3906a"),
    "unstable_separates": Look("unstable, and the motion separates", "#bb5200"),
    "unknown": Look("undecided, or no steady sliding", "#43372a"),
}
"""What linear analysis of steady sliding says, and what the motion from the static start does."""


class SlidingOutcome(Plot):
    """What linear analysis says of steady sliding beside what the motion does, over two parameters.

    x : the parameter along which modes are followed by the study ``sliding``
    """

    quantities = ("regions", "outcome")
    several = True
    named_above = True

    kind: Literal["sliding_outcome"] = "sliding_outcome"
    x: str
    y: str

    @property
    def roles(self) -> Roles:  # type: ignore[override]
        """Steady sliding along x, over y."""
        return {"sliding": Role("sliding", (self.y,), {"parameter": self.x}, required=True)}

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a panel for each normalization; the numbers of points are in the legend."""
        norms = drawing.normalizations(study)
        figure, axes = panels(PAGE, 3.4, 1, len(norms), sharex=True, sharey=True)
        used: dict[str, int] = {}
        for ax, norm in zip(axes, norms, strict=True):
            plane = drawing.of(study, norm).transpose(self.y, self.x, ...)
            linear = drawing.of(overlays["sliding"], norm).rename(value=self.x).transpose(self.y, self.x, ...)
            plane, linear = common_points(plane, linear, (self.x, self.y))
            words = agreement(linear["largest_growth_rate"].values, flag_names(plane["outcome"]))
            fill(ax, edges_of(plane["outcome"]), words, AGREEMENTS)
            for word, count in zip(*np.unique(words, return_counts=True), strict=True):
                used[str(word)] = used.get(str(word), 0) + int(count)
            ax.set(xlabel=drawing.axis_of(self.x)[0], ylabel=drawing.axis_of(self.y)[0])
            ax.label_outer()
        drawing.letters(axes, [drawing.MODES[norm] for norm in norms])
        total = sum(used.values())
        looks = {
            w: look._replace(label=f"{look.label} ({used[w] / total:.0%})")
            for w, look in AGREEMENTS.items()
            if w in used
        }
        figure.legend(handles=patches(looks, used), loc="outside lower center", ncols=2, title="Steady sliding is")
        return figure


def common_points(data: xr.Dataset, other: xr.Dataset, names: Iterable[str]) -> list[xr.Dataset]:
    """Two studies at the values of some dimensions that both have."""
    for name in names:
        alike = np.isclose(data[name].values[:, None], other[name].values, rtol=1e-9, atol=0)
        data, other = data.isel({name: alike.any(axis=1)}), other.isel({name: alike.any(axis=0)})
    return [data, other]


def agreement(growth_rate: np.ndarray, outcome: np.ndarray) -> np.ndarray:
    """Keys of `AGREEMENTS` at points with this growth rate of steady sliding (1/s) and outcome of the static start."""
    quiet = np.isin(outcome, ("quiet", "steady_sliding", "at_rest"))
    grows = np.isin(outcome, ("growing", "other_cycle"))
    motion = np.select([outcome == "separation", grows, quiet], ["separates", "grows", "quiet"], "")
    words = np.char.add(np.where(growth_rate > ROUNDING, "unstable_", "stable_"), motion)
    return np.where(np.isfinite(growth_rate) & (motion != ""), words, "unknown")
