"""Motions, outcomes and modes over a parameter: bifurcation diagrams, ranges of cycles and of late
motion, basins of attraction, probabilities of instability, Campbell diagrams, and eigenvalues of
steady sliding beside the motion."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.classify import share
from disc_model.data.variables import (
    EXCLUDED,
    SAMPLE,
    STABLE_CYCLES,
    flag_names,
    presentation_of,
    stated_in,
    typeset,
)
from disc_model.errors import Fault, suggestion
from disc_model.figures import drawing
from disc_model.figures.cells import edges_of, entries, paint
from disc_model.figures.classes import LOOKS as CLASSES
from disc_model.figures.classes import STABLE
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    GREY,
    PAGE,
    PHASE_COLOURS,
    SEPARATED,
    Axes,
    Figure,
    cm,
    mpl,
    panels,
)
from disc_model.figures.general import LINEAR, scale_rates, unknown
from disc_model.figures.kind import NORM, Plot, Role, Roles, Values
from disc_model.figures.legends import figure_legend, legend_above
from disc_model.units import Finite, Positive, Unit

# ---- Samples once a turn
UNDECIDED: dict[str, Any] = {
    "color": GREY,
    "marker": "o",
    "markersize": 3.0,
    "mfc": "none",
    "mew": 0.5,
}
MARKS: dict[str, dict[str, Any]] = {
    name: {"marker": ".", "markersize": 1.5} for name in PHASE_COLOURS
}
MARKS |= {
    "stick": {"marker": "x", "markersize": 2.0, "mew": 0.4}
}  # in grey print, green and vermilion are alike
EXPONENTS = (
    BLACK,
    BLUE,
    drawing.BROWN,
    GREY,
)  # the largest exponent first; none is the colour of a phase
ERRORS = 4  # half-width of the band about an exponent, in standard errors


class Bifurcation(Plot):
    """The angle ψ once a turn against a parameter, and after how many switches the motion
    repeats."""

    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}
    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    paper_cases: Annotated[dict[str, Finite], Unit(of="x")] = Field(
        {}
    )  # values of x by the paper's name of the case

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw samples by phase, hollow where the motion is not shown to have settled, with crosses
        at failed points, dashes at motions without samples; below periods, and exponents with
        crosses where the largest is missing."""
        study = study.transpose(self.x, "sample", ...)
        by_event = stated_in(study, "options")["section"] == "event"
        names = (
            {"stick": "at release of stick", "separation": "at loss of contact"} if by_event else {}
        )
        heights = [2.4, 0.9, *[1.4] * ("lyapunov" in overlays)]  # inch
        figure, axes = panels(
            PAGE, sum(heights) + 0.7, len(heights), sharex=True, height_ratios=heights
        )
        ax = axes[0]
        xlabel, factor = drawing.axis_of(self.x)
        along, values = study[self.x].values * factor, 1e3 * study["psi"].values
        position = np.broadcast_to(along[:, None], values.shape)
        lost = drawing.failed(study).values
        phase = np.where(lost[:, None], -1, study["phase"].values.astype(int) - 1)
        settled = (flag_names(study["settled"]) == "settled")[:, None]
        dots = [("not settled, or undecided", ~settled & (phase >= 0), UNDECIDED)]
        for code, (name, color) in enumerate(PHASE_COLOURS.items()):
            dots.append(
                (names.get(name, name), settled & (phase == code), MARKS[name] | {"color": color})
            )
        for label, mask, look in dots:
            if mask.any():
                ax.plot(position[mask], values[mask], linestyle="", label=label, **look)
        drawing.mark_failed(ax, along[lost])
        moving = (phase >= 0).any(axis=1)
        slides = flag_names(study["kind"]) == "steady_sliding"
        edge = ax.get_xaxis_transform()
        for label, marker, mask in (
            ("steady sliding", "_", slides),
            ("no event while sampled", "|", ~slides),
        ):
            if (idle := along[mask & ~moving & ~lost]).size:
                ax.plot(
                    idle,
                    np.full(idle.size, 0.02),
                    marker,
                    color=GREY,
                    markersize=4,
                    label=label,
                    transform=edge,
                )
        axes[-1].set_xlabel(xlabel)
        ax.set_ylabel(
            drawing.axis_of("psi")[0].replace("rad", "mrad")
        )  # some hundredths of a radian
        at, period = along[moving], study["period_events"].values[moving]
        repeats = period > 0
        axes[1].plot(at[repeats], period[repeats], ".", color=BLACK, markersize=3)
        axes[1].set(
            yscale="log", ylim=(0.4, None), ylabel="Period\n(events)"
        )  # room for crosses below period 1
        axes[1].yaxis.set_major_formatter("{x:g}")
        drawing.mark_failed(axes[1], at[~repeats], name="not shown to repeat")
        if not repeats.all():
            legend_above(axes[1])
        if "lyapunov" in overlays:
            _exponents(axes[2], overlays["lyapunov"], self.x)
        drawing.letters(axes)
        for panel in axes:
            panel.margins(x=0.01)  # no dot is cut at the edge
        drawing.mark_cases(axes, {case: value * factor for case, value in self.paper_cases.items()})
        for line in legend_above(ax).get_lines():  # the diagram's dots are too small for a legend
            line.set_markersize(6)
        return figure


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors; rings of their colours where they have not
    converged."""
    lyapunov, known = lyapunov.transpose("exponent_number", name, ...), ~drawing.failed(lyapunov)
    exponent, error = (lyapunov[each].where(known) for each in ("exponent", "exponent_error"))
    moving = flag_names(lyapunov["converged"])[: len(EXPONENTS)] == "no"
    along = exponent[name].values * drawing.axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    ring: dict[str, Any] = {
        "color": GREY,
        "markerfacecolor": "none",
        "markersize": 4,
        "markeredgewidth": 0.6,
    }
    for i, color in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        shown = drawing.broken(
            along, exponent[i].values, 0.05
        )  # 1/s, beyond which another motion begins
        ax.plot(*shown, ".-", color=color, markersize=3, linewidth=0.8, label=label)
        band = ERRORS * np.interp(shown[0], along, error[i].values)
        ax.fill_between(
            shown[0], shown[1] - band, shown[1] + band, color=color, alpha=0.15, linewidth=0
        )
        ax.plot(
            along[moving[i]],
            exponent[i][moving[i]],
            "o",
            label="_nolegend_",
            **ring | {"color": color},
        )
    ax.fill_between(
        [], [], [], color=GREY, alpha=0.3, linewidth=0, label=f"± {ERRORS} standard errors"
    )
    if moving.any():
        ax.plot([], [], "o", label="not converged", **ring)
    drawing.mark_failed(ax, along[np.isnan(exponent[0].values)])
    ax.set_ylabel("Lyapunov\nexponents,\nwithout the\ntrivial one (1/s)")
    legend_above(ax)


# ---- Branches of cycles
LOWEST = 1e-3  # least range that is distinguished from rest, mm
THIN = 0.7  # width of lines of unstable motions; dashes of two branches that nearly meet would look like a whole line
BENDS = 2.5  # factor between the heights of neighbouring points beyond which a branch may bend between them
SWEEP_MARK: dict[str, Any] = {"markersize": 2.5, "markerfacecolor": "white", "markeredgewidth": 0.5}
UNSETTLED = "#aaaaaa"  # a sweep's marks where it is not shown that the motion has settled


class Branches(Plot):
    """Range of motion of all cycles found against one parameter, stable and unstable, and where a
    sweep jumps."""

    kind: Literal["branches"] = "branches"
    paper_cases: dict[str, Finite] = Field(
        {}
    )  # values of the parameter by the paper's name of the case

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point: a line for each branch, thick where it is stable, and triangles for the
        sweep up and down."""
        study = study.squeeze([str(dim) for dim in study["status"].dims])  # keeps a single branch
        name = str(stated_in(study, "options")["parameter"])
        label, factor = drawing.axis_of(name)
        figure, [ax] = panels(PAGE, 3.6)
        ax.set_yscale("log")
        for i in range(int(study["n_branches"])):
            branch = study.isel(branch=i)
            color, stable = (
                SEPARATED if branch["separations"] > 0 else BLACK,
                branch["growth_rate"].values < 0,
            )
            draw_branch(
                ax,
                branch["value"].values * factor,
                1e3 * branch["range"].values,
                stable,
                color,
                BENDS,
            )
        along = study["sweep_value"].values * factor
        unstable = study["sliding_growth_rate"].values > 0
        phrase = (
            "unstable"
            if unstable.all()
            else "stable"
            if not unstable.any()
            else "stable where the line is thick"
        )
        draw_branch(ax, along, np.full(along.size, LOWEST), ~unstable, GREY)
        drawing.say(
            ax, f"steady sliding: {phrase}", (along[-1], LOWEST), (-4, 3), fontsize=7, color=GREY
        )
        for way, mark in enumerate("^v"):
            heights, separates = (
                1e3 * study["sweep_range"].values[way],
                study["sweep_separation_rate"].values[way] > 0,
            )
            _swept(
                ax,
                along,
                heights,
                separates,
                flag_names(study["sweep_settled"])[way] == "settled",
                mark,
            )
        drawing.mark_cases(
            [ax], {case: value * factor for case, value in self.paper_cases.items()}, 0.05
        )
        ax.set(xlabel=label, ylabel="Range of the slider's height (mm)")
        ax.set(xlim=(along[0], along[-1]), ylim=(LOWEST * 0.8, None))
        separating = (study["separations"].values > 0).any() or (
            study["sweep_separation_rate"].values > 0
        ).any()
        for color, text in ((BLACK, "in contact"), (SEPARATED, "separating"))[: 1 + separating]:
            ax.plot([], [], color=color, linewidth=2, label=f"stable cycle, {text}")
        ax.plot([], [], color=BLACK, linewidth=THIN, label="unstable cycle")
        handles, labels = ax.get_legend_handles_labels()
        colours = (BLACK, SEPARATED, UNSETTLED)
        up, down = (
            [drawing.sample(ls="", marker=way, c=colour, **SWEEP_MARK) for colour in colours]
            for way in "^v"
        )
        simulated: dict[str, Any] = {"rising": up[0], "falling": down[0]}
        if separating:
            simulated["separating"] = (up[1], down[1])
        swept = np.isfinite(study["sweep_range"].values)
        if (flag_names(study["sweep_settled"])[swept] != "settled").any():
            simulated["not settled, or undecided"] = (up[2], down[2])
        handles += simulated.values()
        labels += [f"simulated, {text}" for text in simulated]
        beside = {tuple: mpl.legend_handler.HandlerTuple(None)}
        figure_legend(
            figure,
            handles,
            loc="outside lower center",
            columns=3,
            labels=labels,
            handler_map=beside,
        )
        return figure


def draw_branch(
    ax: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, color: str, factor: float = np.inf
) -> None:
    """Draw a line along a branch, thick where it is stable, with gaps where its height jumps by
    more than a factor."""
    known = np.isfinite(x)
    x, y, stable = x[known], y[known], stable[known]
    height = np.log(y) if factor < np.inf else None
    ax.plot(*drawing.broken(x, y, np.log(factor), height), color=color, linewidth=THIN)
    # a segment is stable where both its ends are
    for first, last in drawing.stretches(stable[:-1] & stable[1:]):
        ax.plot(
            x[first : last + 1],
            y[first : last + 1],
            color=color,
            linewidth=2.0,
            solid_capstyle="butt",
        )


def _swept(
    ax: Axes, x: np.ndarray, y: np.ndarray, separates: np.ndarray, settled: np.ndarray, mark: str
) -> None:
    """Draw the marks of a sweep, and an arrow at each jump, by a factor of more than 10."""
    shown = np.maximum(y, LOWEST)
    for mask, color in (
        (settled & ~separates, BLACK),
        (settled & separates, SEPARATED),
        (~settled, UNSETTLED),
    ):
        if mask.any():  # the layout leaves room for marks that are not clipped, even for none
            ax.plot(x[mask], shown[mask], mark, color=color, clip_on=False, **SWEEP_MARK)
    order = slice(None) if mark == "^" else slice(None, None, -1)
    x, y, jumps = x[order], shown[order], np.abs(np.diff(np.log10(np.maximum(y[order], 1e-9)))) > 1
    for i in np.flatnonzero(jumps & (y[1:] != y[:-1])):
        ax.annotate(
            "",
            (x[i + 1], y[i + 1]),
            (x[i], y[i]),
            arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0},
        )


# ---- Late in the motion
LOAD_COLOURS = (BLACK, BLUE, drawing.GREEN, drawing.PURPLE)
SMALLEST = 1e-6  # thicknesses, least range drawn: a quiet cycle moves the slider by less than a millionth of a metre


class LateRange(Plot):
    """Peak-to-peak displacement of the slider against the speed, with separation and with it
    ignored."""

    quantities = ("outcome",)
    kind: Literal["late_range"] = "late_range"
    by: str = "disc"  # dimension with a panel for each value
    thickness: Positive = 0.002  # of the disc, m; that of the paper unless given
    not_valid: tuple[
        dict[str, tuple[Finite | str, ...]], ...
    ] = ()  # points at which the law of friction does not hold
    names: dict[str, str] = Field({})  # words for values of `by`

    @property
    def dims(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("Omega", "N", "contact", self.by)

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        chosen = [("not_valid", *item) for part in self.not_valid for item in part.items()]
        for key, dim, words in (("names", self.by, self.names), *chosen):
            yield from unknown(key, words, dim, values.get(dim, ()) if dim in self.dims else ())

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        ranges = (study["u_max"] - study["u_min"]) / self.thickness
        outcomes = study["outcome"].copy(data=flag_names(study["outcome"]))
        valid = xr.ones_like(ranges, dtype=bool)
        for part in self.not_valid:
            valid.loc[{dim: [*chosen] for dim, chosen in part.items()}] = False
        names, loads, speeds = (study[dim].values for dim in (self.by, "N", "Omega"))
        apart: dict[str, Any] = {"linestyle": "", "marker": "o", "markersize": 3}
        open_end = apart | {"marker": "^", "markersize": 5, "markerfacecolor": "white"}
        settled = apart | {"markerfacecolor": "white"}
        figure, axes = panels(PAGE, 3.0, 1, len(names), sharex=True, sharey=True)
        for ax, name in zip(axes, names, strict=True):
            ax.axhspan(1, 1e3, color="0.93", zorder=0)
            for load, colour in zip(loads, LOAD_COLOURS, strict=False):
                for contact, look in (("unilateral", "-"), ("bilateral", "--")):
                    line = {self.by: name, "N": load, "contact": contact}
                    heights, words, holds = (
                        values.sel(line).values for values in (ranges, outcomes, valid)
                    )
                    heights = np.where(holds, heights, np.nan)
                    ax.plot(speeds, heights, look, color=colour, linewidth=1.0)
                    ends, open_ends = (
                        words == "separation",
                        np.isin(words, ["growing", "undecided"]),
                    )
                    for mark, shown in (
                        (apart, ends),
                        (open_end, open_ends),
                        (settled, ~(ends | open_ends)),
                    ):
                        ax.plot(speeds, np.where(shown, heights, np.nan), color=colour, **mark)
            ax.margins(x=0.05)
            ax.set(yscale="log", ylim=(SMALLEST, 10), xlabel=drawing.label_of(study["Omega"])[0])
        axes[0].set_ylabel("Slider, peak to peak (thicknesses)")
        axes[0].text(
            0.03,
            0.99,
            "beyond linear plate theory",
            transform=axes[0].transAxes,
            va="top",
            c=GREY,
            size=6,
        )
        drawing.letters(axes, [self.names.get(str(name), str(name)) for name in names])
        looks: list[dict[str, Any]] = [
            *(
                {"color": c, "label": f"{1e-3 * n:g} kN"}
                for n, c in zip(loads, LOAD_COLOURS, strict=False)
            ),
            {"linestyle": "-", "label": "with separation"},
            {"linestyle": "--", "label": "separation ignored"},
            apart | {"label": "separates"},
            open_end | {"label": "growing or undecided"},
            settled | {"label": "settled in contact"},
        ]
        handles = [drawing.sample(**{"color": GREY} | look) for look in looks]
        figure_legend(figure, handles, loc="outside lower center", columns=4, columnspacing=1.0)
        return figure


# ---- Outcomes of many starts
STACKED = (  # order in which shares of outcomes are stacked
    "quiet",
    "other_cycle",
    "separating",
    "quasi_periodic",
    "irregular",
    "steady_sliding",
    "at_rest",
    "undecided",
    "failed",
)
LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a
    parameter."""

    kind: Literal["basins"] = "basins"
    x: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw the fractions for each energy; below, attractors by range, as large as their
        fractions, and energies."""
        study = study.transpose(self.x, ...)
        (label, along), energies = drawing.along(study[self.x]), study["energy"].values
        figure = drawing.new_figure(PAGE, 4.6)
        above, below = np.asarray(figure.subfigures(2, 1))
        axes = [
            *above.subplots(1, len(energies), sharey=True, squeeze=False)[0],
            *below.subplots(1, 2),
        ]
        classes = outcomes_in(study["basin_fraction"])
        for ax, energy in zip(axes, energies, strict=False):
            draw_shares(ax, study["basin_fraction_by_energy"].sel(energy=energy), classes, along)
        axes[0].set_ylabel(f"Fraction of {study.sizes['start']} starts")
        _attractors(axes[-2], study, along)
        _kicks(axes[-1], study, along)
        drawing.letters(axes, [f"{energy:g} J" for energy in energies])
        for ax in axes:
            ax.margins(x=0.04)
            ax.set_xlabel(label)
            drawing.mark_failed(ax, along[drawing.failed(study).values])
        undecided = CLASSES["undecided"]._replace(
            label=f"undecided after {stated_in(study, 'options')['horizon']:g} s"
        )
        handles = entries(classes, {**CLASSES, "undecided": undecided})
        figure_legend(figure, handles, loc="outside lower center")
        return figure


def outcomes_in(shares: xr.DataArray) -> list[str]:
    """The outcomes that occur among the starts, in the order in which their shares are stacked."""
    return [class_ for class_ in STACKED if (shares.sel(attractor_class=class_) > 0).any()]


def draw_shares(ax: Axes, shares: xr.DataArray, classes: Sequence[str], along: np.ndarray) -> None:
    """Draw the shares of outcomes along another dimension, stacked, as bars at the places
    `along`."""
    width = 0.9 * np.diff(along).min(initial=1.0)
    shares = shares.sel(attractor_class=[*classes]).transpose("attractor_class", ...)
    below = shares.cumsum("attractor_class") - shares.fillna(0)
    for class_, heights, bottoms in zip(classes, shares, below, strict=True):
        look = CLASSES[class_]
        ax.bar(along, heights, width, bottoms, fc=look.face, hatch=look.hatch, ec=look.ink, lw=0.4)
    ax.set(ylim=(0, 1))


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    study = study.transpose(..., "attractor")
    kinds, starts = flag_names(study["attractor_kind"]), study["attractor_starts"].values
    ranges = 1e3 * study["attractor_range"].values
    total = study.sizes["energy"] * study.sizes["start"]
    for class_ in STACKED:
        look = CLASSES[class_]
        point, number = np.nonzero((kinds == class_) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        mark: dict[str, Any] = {
            "marker": "D" if look.hatch else "o",
            "edgecolor": BLACK,
            "linewidth": 0.4,
            "zorder": 3,
        }
        ax.scatter(along[point], ranges[point, number], area, color=look.face, **mark)
    for part, text in ((0.1, "10 %"), (0.5, "50 %"), (1.0, "all starts")):
        ax.scatter(
            [], [], LARGEST * part, facecolor="none", edgecolor=BLACK, linewidth=0.4, label=text
        )
    legend_above(ax)
    ax.set(ylabel="Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all
    their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "sampled" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, bound = study["critical_energy_sampled"].values, study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="lowest separating")
    ax.plot(
        along,
        np.where(bound > 0, bound, np.nan),
        "v-",
        color=SEPARATED,
        markersize=3.5,
        label="by bisection",
    )
    ax.set(ylabel="Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # energy 0 has no place on this logarithmic scale
        for x in along[bound == 0]:
            drawing.say(
                ax,
                "0",
                (x, 0),
                (0, 2),
                xycoords=("data", "axes fraction"),
                color=SEPARATED,
                fontsize=7,
            )
    legend_above(ax, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)


# ---- Probability of instability against each uncertain parameter
MOST_PANELS = 4  # greatest number of points that a figure shows
BINS = 3  # number of parts, with equal numbers of draws, of a parameter's distribution


class Sensitivity(Plot):
    """Probability of instability in the lowest and in the highest third of each parameter; for up
    to four points."""

    several = True
    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            rule = f"has room for {MOST_PANELS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw rows with 95 % intervals, those above that change most; the line is the probability
        at all values."""
        cells = list(cells_of(study))
        names = [str(name) for name in study["parameter"].values]
        each = np.array([[probabilities(cell, name) for name in names] for _, cell in cells])
        order = np.abs(each[:, :, -1, 0] - each[:, :, 0, 0]).max(axis=0).argsort(kind="stable")
        names, rows = [names[i] for i in order], np.arange(len(names), dtype=float)
        figure, axes = panels(PAGE, 1.2 + 0.2 * len(names), 1, len(cells), sharey=True)
        for ax, (title, cell), thirds in zip(axes, cells, each[:, order], strict=True):
            ax.axvline(
                float(cell["probability_unstable"]),
                color=BLACK,
                linewidth=0.7,
                linestyle=(0, (3, 2)),
            )
            ax.hlines(rows, thirds[:, 0, 0], thirds[:, -1, 0], color=GREY, linewidth=0.8)
            for end, up, face, label in (
                (0, -0.12, "white", "lowest third"),
                (-1, 0.12, BLUE, "highest third"),
            ):
                value, low, high = thirds[:, end].T
                look: dict[str, Any] = {
                    "fmt": "o",
                    "color": BLUE,
                    "markerfacecolor": face,
                    "markersize": 4,
                }
                bars = np.maximum([value - low, high - value], 0.0)  # rounding
                ax.errorbar(
                    value,
                    rows + up,
                    xerr=bars,
                    elinewidth=0.8,
                    label=f"{label} of its values",
                    **look,
                )
            ax.set(xlabel="P(unstable)", xlim=(-0.03, 1.03), ylim=(-0.6, len(names) - 0.4))
            ax.set_title(
                "\n".join(title.replace("Preload ", "").replace("Speed ", "").split(", ")),
                loc="left",
            )
        axes[0].set_ylabel("Parameter")
        axes[0].set_yticks(
            rows,
            labels=[typeset(presentation_of(name)[1]) or name.replace("_", " ") for name in names],
        )
        axes[0].minorticks_off()
        handles = axes[0].get_legend_handles_labels()[0]
        figure_legend(figure, handles, loc="outside lower center", columns=2)
        return figure


def probabilities(cell: xr.Dataset, name: str) -> np.ndarray:
    """Probability of instability in each part of a parameter's values, and the ends of its
    interval: (parts, 3)."""
    values, words = cell["parameter_values"].sel(parameter=name).values, flag_names(cell["cycle"])
    known, unstable = words != "failed", ~np.isin(words, STABLE_CYCLES)
    edges = np.quantile(values, np.linspace(0, 1, BINS + 1))
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, BINS - 1)
    counts = [
        (int((unstable & known & (part == i)).sum()), int((known & (part == i)).sum()))
        for i in range(BINS)
    ]
    return np.array([share(*count) for count in counts])


def cells_of(study: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Name and values of each point of the grid that has samples left, without the dimension of
    samples."""
    dims = [str(dim) for dim in study["status"].dims if dim != SAMPLE]
    names = [
        str(name)
        for name, values in study.coords.items()
        if values.dims and {*values.dims} <= {*dims}
    ]
    for index in np.ndindex(*(study.sizes[dim] for dim in dims)):
        cell = study.isel(dict(zip(dims, index, strict=True)))
        cell = cell.isel({SAMPLE: flag_names(cell["status"]) != EXCLUDED})
        if cell.sizes[SAMPLE]:
            yield ", ".join(drawing.coordinate_text(cell[name], name) for name in names), cell


# ---- Campbell diagrams
MOST = 5  # number of peaks that are named at most
NEAR = 0.01  # share of the speeds shown within which peaks are one, and crossings belong to a peak
DOT: dict[str, Any] = {"color": BLACK, "linestyle": "", "marker": "o", "markersize": 3.5}
HOLLOW: dict[str, Any] = {"markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.7}


class Campbell(Plot):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the
    stick-slip frequency."""

    needs = ("Omega",)
    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = (
        None  # the one shown, where the study has several
    )

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        yield from super()._wrong_dims(
            values if self.normalization is None else {**values, NORM: ()}
        )
        known = values.get(NORM, ())
        if self.normalization is not None and known and self.normalization not in known:
            yield Fault.of(
                (NORM,),
                self.normalization,
                f"is not computed{suggestion(self.normalization, known)}",
            )

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        study = study.transpose("Omega", ...)
        speeds, rate = study["Omega"].values, study["growth_rate"].values
        figure, [top, bottom] = panels(PAGE, 5.4, 2, height_ratios=[3, 2], sharex=True)
        top.plot(speeds, study["sliding_frequency"], color=BLACK, linewidth=0.9)
        highest = 1.06 * float(study["sliding_frequency"].max())
        ends = study.isel(Omega=-1)
        of_disc = np.where(flag_names(ends["mode_kind"]) == "disc", ends["diameters"].values, -1)
        for part, name in named_modes(of_disc, ends["sliding_frequency"].values, 0.035 * highest):
            height = float(ends["sliding_frequency"][part].mean())
            drawing.say_beside(top, height, name, 3, fontsize=7)
        bottom.plot(*drawing.broken(speeds, rate, LINEAR), "-", color=BLACK, linewidth=0.8)
        by_itself = unjoined(rate)
        for mask, look in ((~by_itself, {}), (by_itself, HOLLOW)):
            bottom.plot(speeds[mask], rate[mask], **DOT | {"markersize": 1.0} | look)
        scale_rates(bottom)
        beside: dict[str, Any] = {"fontsize": 7, "path_effects": drawing.halo()}
        for i, crossing in peaks(study):
            for ax in (top, bottom):
                ax.axvline(speeds[i], color=GREY, linewidth=0.4, zorder=0)
            bottom.plot(speeds[i], rate[i], **DOT | (HOLLOW if by_itself[i] else {}))
            if crossing is None:
                continue
            multiple, symbol, line = (
                float(crossing["crossing_multiple"]),
                "f_Ω",
                study["rotation_frequency"],
            )
            if flag_names(crossing["crossing_line"]) == "stick_slip":
                symbol, line = "f_s", study["stick_slip_frequency"]
            top.plot(
                speeds, multiple * line, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)), zorder=0
            )
            meeting = float(crossing["crossing_Omega"]), float(crossing["crossing_frequency"])
            top.plot(*meeting, **DOT)
            drawing.say(
                top, f"{multiple:g} ${symbol}$", meeting, (4, -1), **beside | {"fontsize": 6}
            )
            drawing.say(bottom, f"{multiple:g} ${symbol}$", (speeds[i], rate[i]), (2, 3), **beside)
        for ax in (top, bottom):
            for low, high in drawing.spans(speeds, ~np.isfinite(rate)):  # without a cycle
                ax.axvspan(low, high, color=GREY, alpha=0.25, linewidth=0)
        low, high = (float(end.reduce(rate, initial=0.0)) for end in (np.fmin, np.fmax))
        bottom.set(
            ylim=(min(1.3 * low, -LINEAR), max(3 * high, LINEAR)),
            xlabel=drawing.axis_of("Omega")[0],
        )
        bottom.set_ylabel("Largest growth rate\nof the cycle (1/s)")
        top.set(
            xlim=speeds[[0, -1]], ylim=(0, highest), ylabel="Frequency in the slider's frame (Hz)"
        )
        drawing.letters([top, bottom])
        return figure


def peaks(study: xr.Dataset) -> Iterator[tuple[int, xr.Dataset | None]]:
    """The `MOST` highest peaks of the cycle's growth rate from `LINEAR` on: index of the speed, and
    the nearest crossing, of the leading mode if possible; without points by themselves beside gaps,
    which are of another cycle."""
    speeds, rate = study["Omega"].values, study["growth_rate"].values.copy()
    for first, after in drawing.stretches(unjoined(rate)):
        if np.isnan(rate[[max(first - 1, 0), min(after, rate.size - 1)]]).any():
            rate[first:after] = np.nan
    rate = np.nan_to_num(rate, nan=-np.inf)
    beside = np.abs(speeds - speeds[:, None]) <= NEAR * np.ptp(speeds)
    tops = np.flatnonzero((rate >= LINEAR) & (rate == np.where(beside, rate, -np.inf).max(axis=1)))
    for i in sorted(tops, key=lambda i: -rate[i])[:MOST]:
        leads = study["mode"][int(np.nanargmax(study["cycle_growth_rate"].values[i]))]
        apart = np.abs(study["crossing_Omega"].values - speeds[i])
        other = np.where(study["crossing_mode"] == leads, 0.0, np.ptp(speeds))
        distance = np.where(apart <= NEAR * np.ptp(speeds), apart + other, np.inf)
        yield (
            int(i),
            study.isel(crossing=int(distance.argmin())) if np.isfinite(distance).any() else None,
        )


def unjoined(rate: np.ndarray) -> np.ndarray:
    """Points whose growth rate differs by more than `LINEAR` from those of both neighbours."""
    joined = np.concatenate([[False], np.abs(np.diff(rate)) <= LINEAR, [False]])
    return np.isfinite(rate) & ~(joined[:-1] | joined[1:])


def name_of(*diameters: int) -> str:
    """Name of modes by their nodal diameters; -1: in the plane."""
    numbers = [str(l) for l in sorted({*diameters}) if l >= 0]
    return ", ".join(
        ["in-plane"] * (min(diameters) < 0) + [f"l = {', '.join(numbers)}"] * bool(numbers)
    )


def named_modes(
    diameters: np.ndarray, heights: np.ndarray, apart: float
) -> Iterator[tuple[np.ndarray, str]]:
    """Indices of modes, ascending by height, and their names; those nearer than `apart` to the one
    below share one."""
    known = np.argsort(heights)[: int(np.isfinite(heights).sum())]
    for part in np.split(known, np.flatnonzero(np.diff(heights[known]) > apart) + 1):
        if part.size:
            yield part, name_of(*diameters[part].tolist())


# ---- Modes of steady sliding along a parameter, root loci, and what the motion really does
DECAYS, GROWS = 0.8, 2.4  # widths of the lines of modes
ROUNDING = 1e-9  # 1/s, growth rates of undamped modes by rounding


class SlidingModes(Plot):
    """Frequencies and growth rates of steady sliding's modes along a parameter; where two meet,
    they coalesce."""

    quantities = ("sliding",)
    kind: Literal["sliding_modes"] = "sliding_modes"
    highest: Annotated[Positive, Unit("Hz")] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw lines, thick where a mode grows. Growth at 0 Hz is of no mode, and drawn where it is
        the largest."""
        study = study.squeeze()
        label, along = drawing.along(study["value"])
        figure, [top, bottom] = panels(PAGE, 5.6, 2, height_ratios=[5, 4], sharex=True)
        largest = study["largest_growth_rate"]
        diverging = (largest > study["mode_growth_rate"].max("mode") + ROUNDING).values
        lines: list[tuple[Any, ...]] = []
        for _, mode in study.groupby("mode"):
            mode = mode.squeeze("mode")
            frequency, rate = mode["frequency"].values, mode["mode_growth_rate"].values
            diameters = np.where(np.isfinite(frequency), mode["diameters"], np.nan)
            for l in np.unique(
                diameters[np.isfinite(diameters)]
            ):  # the mode is cut where its nodal diameters change
                lines.append(
                    (
                        name_of(int(l)),
                        *(np.where(diameters == l, x, np.nan) for x in (frequency, rate)),
                    )
                )
        all_rates = np.array([rate for *_, rate in lines])
        at_zero = [np.where(diverging, values, np.nan) for values in (0 * largest, largest)]
        for name, frequency, rate in (*lines, ("0 Hz", *at_zero)):
            grows = np.nan_to_num(rate) > ROUNDING
            for ax, values in ((top, frequency), (bottom, rate)):
                ax.plot(along, values, ".-", color=GREY, linewidth=DECAYS, markersize=1.2)
                ax.plot(
                    along,
                    np.where(grows, values, np.nan),
                    ".-",
                    color=BLACK,
                    linewidth=GROWS,
                    markersize=3,
                )
            for start, after in drawing.stretches(grows[:-1] & grows[1:]):
                shown = slice(
                    start, after + 1
                )  # the name is where there is room above, and else at the largest rate
                above = all_rates[:, shown] - rate[shown]
                room = np.where(above > 0, above, np.inf).min(
                    axis=0, initial=0.25 * float(largest.max())
                )
                i = start + int(np.lexsort((rate[shown], room))[-1])
                offset = (3, 0) if i == along.size - 1 else (0, 3)
                drawing.say(
                    bottom,
                    name,
                    (along[i], rate[i]),
                    offset,
                    fontsize=7,
                    path_effects=drawing.halo(),
                )
        bottom.axhline(0, color=BLACK, linewidth=0.5)
        highest = self.highest or top.get_ylim()[1]
        top.set(
            ylabel="Frequency in the slider's frame (Hz)", xlim=along[[0, -1]], ylim=(0, highest)
        )
        first = study.isel(value=0)
        for part, name in named_modes(
            first["diameters"].values, first["frequency"].values, 0.04 * highest
        ):
            left_end = along[0], float(first["frequency"][part].mean())
            drawing.say(
                top, name, left_end, (3, 0), fontsize=7, bbox={"fc": "white", "lw": 0, "pad": 1}
            )
        # the sign matters: decay of high modes may be much faster
        low, top_rate = float(study["mode_growth_rate"].min()), max(float(largest.max()), 0.1)
        bottom.set(
            xlabel=label,
            ylabel="Growth rate (1/s)",
            ylim=(max(1.1 * low, -top_rate), 1.1 * top_rate),
        )
        last = study.isel(value=-1)
        decay = (
            last["mode_growth_rate"]
            .where(lambda rates: (rates < -ROUNDING) & (rates > -top_rate))
            .values
        )
        for part, name in named_modes(last["diameters"].values, decay, 0.1 * top_rate):
            drawing.say_beside(bottom, float(decay[part].mean()), name, 3, fontsize=7, color=GREY)
        drawing.letters([top, bottom])
        return figure


class RootLocus(Plot):
    """Eigenvalues of steady sliding in the plane of growth rate and frequency, coloured along the
    parameter."""

    quantities = ("sliding",)
    kind: Literal["root_locus"] = "root_locus"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw points, with a ring where a mode begins, and its name on the side from which it
        leads away."""
        study = study.squeeze()
        label, along = drawing.along(study["value"])
        figure, [ax] = panels(PAGE, 4.8)
        for _, mode in study.groupby("mode"):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            points = ax.scatter(
                rate,
                frequency,
                c=along,
                cmap=cm.batlow,
                vmin=along[0],
                vmax=along[-1],
                s=5,
                zorder=2,
            )
        first = study.isel(value=0)
        rates, heights = first["mode_growth_rate"].values, first["frequency"].values
        ax.plot(rates, heights, "o", color=BLACK, markersize=4, markerfacecolor="white")
        ahead = study["mode_growth_rate"].isel(value=1).values - rates
        letter_width = 0.0136 * float(
            study["mode_growth_rate"].max() - study["mode_growth_rate"].min()
        )
        for part, name in named_modes(
            first["diameters"].values, heights, 0.01 * float(study["frequency"].max())
        ):
            side, ring = (
                (-1, rates[part].min()) if ahead[part].mean() > 0 else (1, rates[part].max())
            )
            if (
                side > 0 and -letter_width * len(name) < ring < 0
            ):  # the name would cross the line of zero growth
                side, ring = -1, float(study["mode_growth_rate"].isel(mode=part).min())
            drawing.say(
                ax,
                name,
                (ring, heights[part].mean()),
                (4 * side, 0),
                fontsize=7,
                path_effects=drawing.halo(),
            )
        ax.axvline(0, color=BLACK, linewidth=0.6)
        ax.margins(x=0.02)
        ax.set(xlabel="Growth rate (1/s)", ylabel="Frequency in the slider's frame (Hz)")
        figure.colorbar(points, ax=ax, label=label, pad=0.01, aspect=30)
        return figure


AGREEMENTS = {  # what linear analysis of steady sliding says (dots: stable), and what the motion from the start does
    "stable_quiet": STABLE._replace(
        label="stable, and the motion quiet", face=CLASSES["quiet"].face
    ),
    "stable_grows": STABLE._replace(
        label="stable, but the motion leaves the quiet cycle in contact",
        face=CLASSES["growing"].face,
    ),
    "stable_separates": STABLE._replace(
        label="stable, but the motion separates", face=CLASSES["separation"].face
    ),
    "unstable_quiet": CLASSES["quiet"]._replace(label="unstable, but the motion stays quiet"),
    "unstable_grows": CLASSES["growing"]._replace(
        label="unstable, and the motion grows, or reaches another cycle, in contact"
    ),
    "unstable_separates": CLASSES["separation"]._replace(
        label="unstable, and the motion separates"
    ),
    "unknown": CLASSES["undecided"]._replace(label="undecided, or no steady sliding"),
}


class SlidingOutcome(Plot):
    """What linear analysis says of steady sliding beside what the motion does, over two
    parameters."""

    quantities = ("regions", "outcome")
    several = True
    kind: Literal["sliding_outcome"] = "sliding_outcome"
    x: str
    y: str

    @property
    def roles(self) -> Roles:  # type: ignore[override]
        return {"sliding": Role("sliding", (self.y,), {"parameter": self.x}, required=True)}

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        norms = drawing.normalizations(study)
        figure, axes = panels(PAGE, 3.4, 1, len(norms), sharex=True, sharey=True)
        each: list[np.ndarray] = []
        for ax, norm in zip(axes, norms, strict=True):
            plane = drawing.of(study, norm).transpose(self.y, self.x, ...)
            linear = (
                drawing.of(overlays["sliding"], norm)
                .rename(value=self.x)
                .transpose(self.y, self.x, ...)
            )
            plane, linear = common_points(plane, linear, (self.x, self.y))
            words = agreement(linear["largest_growth_rate"].values, flag_names(plane["outcome"]))
            paint(ax, edges_of(plane["outcome"]), words, AGREEMENTS)
            each.append(words)
            ax.set(xlabel=drawing.axis_of(self.x)[0], ylabel=drawing.axis_of(self.y)[0])
            ax.label_outer()
        if len(norms) > 1:  # one alone stands in the figure's title
            drawing.letters(axes, [drawing.MODES[norm] for norm in norms])
        names, looks = ("(a) ", "(b) ") if len(each) > 1 else ("",), {}
        for word, look in AGREEMENTS.items():
            shares = [
                f"{letter}{percent(np.mean(words == word))}"
                for letter, words in zip(names, each, strict=False)
            ]
            looks[word] = look._replace(label=f"{look.label}: {', '.join(shares)}")
        handles = entries(np.concatenate(each, axis=None), looks)
        figure_legend(
            figure, handles, loc="outside lower center", columns=1, title="Steady sliding is"
        )
        return figure


def percent(share: float) -> str:
    """A share in whole percent; one that rounds to nothing is not called nothing."""
    return "< 1 %" if 0 < share < 0.005 else f"{100 * share:.0f} %"


def common_points(data: xr.Dataset, other: xr.Dataset, names: Iterable[str]) -> list[xr.Dataset]:
    """Two studies at the values of some dimensions that both have."""
    for name in names:
        alike = np.isclose(data[name].values[:, None], other[name].values, rtol=1e-9, atol=0)
        data, other = data.isel({name: alike.any(axis=1)}), other.isel({name: alike.any(axis=0)})
    return [data, other]


def agreement(growth_rate: np.ndarray, outcome: np.ndarray) -> np.ndarray:
    """Keys of `AGREEMENTS` at points with this growth rate of steady sliding (1/s) and outcome of
    the static start."""
    quiet = np.isin(outcome, ("quiet", "steady_sliding", "at_rest"))
    grows = np.isin(outcome, ("growing", "other_cycle"))
    motion = np.select([outcome == "separation", grows, quiet], ["separates", "grows", "quiet"], "")
    words = np.char.add(np.where(growth_rate > ROUNDING, "unstable_", "stable_"), motion)
    return np.where(np.isfinite(growth_rate) & (motion != ""), words, "unknown")
