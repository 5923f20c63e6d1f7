"""Motions and outcomes against a parameter: bifurcation diagrams, the range of cycles along branches, and that of late
motion; basins of attraction, and probabilities of instability where parameters are uncertain."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.classify import share
from disc_model.data.variables import EXCLUDED, SAMPLE, STABLE_CYCLES, flag_names, presentation_of, stated_in, typeset
from disc_model.errors import Fault, suggestion
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREY, PAGE, PHASE_COLOURS, SEPARATED, Axes, Figure, mpl, panels
from disc_model.figures.kind import Plot, Role, Roles, Values
from disc_model.figures.maps import OUTCOME_LOOKS, Look, patches
from disc_model.units import Finite, Positive, Unit

UNDECIDED: dict[str, Any] = {"color": GREY, "marker": "o", "markersize": 3.0, "mfc": "none", "mew": 0.5}
MARKS: dict[str, dict[str, Any]] = {name: {"marker": ".", "markersize": 1.5} for name in PHASE_COLOURS}
MARKS |= {"stick": {"marker": "x", "markersize": 2.0, "mew": 0.4}}  # in grey print, green and vermilion are alike
EXPONENTS = (BLACK, BLUE, drawing.BROWN, GREY)  # the largest exponent first; none is the colour of a phase
ERRORS = 4  # half-width of the band about an exponent, in standard errors


class Bifurcation(Plot):
    """Samples once a turn against a parameter, and after how many switches the motion repeats."""

    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}
    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    variable: Literal["psi", "psi_velocity", "P", "u", "w_point"] = "psi"
    paper_cases: Annotated[dict[str, Finite], Unit(of="x")] = Field({})  # values of x by the paper's name of the case

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw samples by phase, hollow where the motion is not shown to have settled, with crosses at failed points,
        dashes at motions without samples; below periods, and exponents with crosses where the largest is missing."""
        study = study.transpose(self.x, "sample", ...)
        by_event = stated_in(study, "options")["section"] == "event"
        names = {"stick": "at release of stick", "separation": "at loss of contact"} if by_event else {}
        heights = [2.4, 0.9, *[1.4] * ("lyapunov" in overlays)]  # inch
        figure, axes = panels(PAGE, sum(heights) + 0.7, len(heights), sharex=True, height_ratios=heights)
        ax = axes[0]
        xlabel, factor = drawing.axis_of(self.x)
        ylabel, scale = drawing.axis_of(self.variable)
        if self.variable == "psi":  # some hundredths of a radian
            ylabel, scale = ylabel.replace("rad", "mrad"), 1e3
        along, values = study[self.x].values * factor, study[self.variable].values * scale
        position = np.broadcast_to(along[:, None], values.shape)
        lost = drawing.failed(study).values
        phase = np.where(lost[:, None], -1, study["phase"].values.astype(int) - 1)
        settled = (flag_names(study["settled"]) == "settled")[:, None]
        dots = [("not settled, or undecided", ~settled & (phase >= 0), UNDECIDED)]
        for code, (name, color) in enumerate(PHASE_COLOURS.items()):
            dots.append((names.get(name, name), settled & (phase == code), MARKS[name] | {"color": color}))
        for label, mask, look in dots:
            if mask.any():
                ax.plot(position[mask], values[mask], linestyle="", label=label, **look)
        drawing.mark_failed(ax, along[lost])
        moving = (phase >= 0).any(axis=1)
        slides = flag_names(study["kind"]) == "steady_sliding"
        edge = ax.get_xaxis_transform()
        for label, marker, mask in (("steady sliding", "_", slides), ("no event while sampled", "|", ~slides)):
            if (idle := along[mask & ~moving & ~lost]).size:
                ax.plot(idle, np.full(idle.size, 0.02), marker, color=GREY, markersize=4, label=label, transform=edge)
        axes[-1].set_xlabel(xlabel)
        ax.set_ylabel(ylabel)
        at, period = along[moving], study["period_events"].values[moving]
        repeats = period > 0
        axes[1].plot(at[repeats], period[repeats], ".", color=BLACK, markersize=3)
        axes[1].set(yscale="log", ylim=(0.4, None), ylabel="Period\n(events)")  # room for crosses below period 1
        axes[1].yaxis.set_major_formatter("{x:g}")
        drawing.mark_failed(axes[1], at[~repeats], name="not shown to repeat")
        if not repeats.all():
            drawing.legend_above(axes[1])
        if "lyapunov" in overlays:
            _exponents(axes[2], overlays["lyapunov"], self.x)
        drawing.letters(axes)
        for panel in axes:
            panel.margins(x=0.01)  # no dot is cut at the edge
        drawing.mark_cases(axes, {case: value * factor for case, value in self.paper_cases.items()})
        for line in drawing.legend_above(ax).get_lines():  # the diagram's dots are too small for a legend
            line.set_markersize(6)
        return figure


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors; rings of their colours where they have not converged."""
    lyapunov, known = lyapunov.transpose("exponent_number", name, ...), ~drawing.failed(lyapunov)
    exponent, error = (lyapunov[each].where(known) for each in ("exponent", "exponent_error"))
    moving = flag_names(lyapunov["converged"])[: len(EXPONENTS)] == "no"
    along = exponent[name].values * drawing.axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    ring: dict[str, Any] = {"color": GREY, "markerfacecolor": "none", "markersize": 4, "markeredgewidth": 0.6}
    for i, color in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        shown = drawing.broken(along, exponent[i].values, 0.05)  # 1/s, beyond which another motion begins
        ax.plot(*shown, ".-", color=color, markersize=3, linewidth=0.8, label=label)
        band = ERRORS * np.interp(shown[0], along, error[i].values)
        ax.fill_between(shown[0], shown[1] - band, shown[1] + band, color=color, alpha=0.15, linewidth=0)
        ax.plot(along[moving[i]], exponent[i][moving[i]], "o", label="_nolegend_", **ring | {"color": color})
    ax.fill_between([], [], [], color=GREY, alpha=0.3, linewidth=0, label=f"± {ERRORS} standard errors")
    if moving.any():
        ax.plot([], [], "o", label="not converged", **ring)
    drawing.mark_failed(ax, along[np.isnan(exponent[0].values)])
    ax.set_ylabel("Lyapunov\nexponents,\nwithout the\ntrivial one (1/s)")
    drawing.legend_above(ax)


# ---- Branches of cycles
LOWEST = 1e-3  # least range that is distinguished from rest, mm
THIN = 0.7  # width of lines of unstable motions; dashes of two branches that nearly meet would look like a whole line
BENDS = 2.5  # factor between the heights of neighbouring points beyond which a branch may bend between them
SWEEP_MARK: dict[str, Any] = {"markersize": 2.5, "markerfacecolor": "white", "markeredgewidth": 0.5}
UNSETTLED = "#aaaaaa"  # a sweep's marks where it is not shown that the motion has settled


class Branches(Plot):
    """Range of motion of all cycles found against one parameter, stable and unstable, and where a sweep jumps."""

    kind: Literal["branches"] = "branches"
    paper_cases: dict[str, Finite] = Field({})  # values of the parameter by the paper's name of the case

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point: a line for each branch, thick where it is stable, and triangles for the sweep up and down."""
        study = study.squeeze()
        name = str(stated_in(study, "options")["parameter"])
        label, factor = drawing.axis_of(name)
        figure, [ax] = panels(PAGE, 3.6)
        ax.set_yscale("log")
        for i in range(int(study["n_branches"])):
            branch = study.isel(branch=i)
            color, stable = SEPARATED if branch["separations"] > 0 else BLACK, branch["growth_rate"].values < 0
            draw_branch(ax, branch["value"].values * factor, 1e3 * branch["range"].values, stable, color, BENDS)
        along = study["sweep_value"].values * factor
        unstable = study["sliding_growth_rate"].values > 0
        phrase = "unstable" if unstable.all() else "stable" if not unstable.any() else "stable where the line is thick"
        draw_branch(ax, along, np.full(along.size, LOWEST), ~unstable, GREY)
        drawing.say(ax, f"steady sliding: {phrase}", (along[-1], LOWEST), (-4, 3), fontsize=7, color=GREY)
        for way, mark in enumerate("^v"):
            heights, separates = 1e3 * study["sweep_range"].values[way], study["sweep_separation_rate"].values[way] > 0
            _swept(ax, along, heights, separates, flag_names(study["sweep_settled"])[way] == "settled", mark)
        drawing.mark_cases([ax], {case: value * factor for case, value in self.paper_cases.items()}, 0.05)
        ax.set(xlabel=label, ylabel="Range of the slider's height (mm)")
        ax.set(xlim=(along[0], along[-1]), ylim=(LOWEST * 0.8, None))
        separating = (study["separations"].values > 0).any() or (study["sweep_separation_rate"].values > 0).any()
        for color, text in ((BLACK, "in contact"), (SEPARATED, "separating"))[: 1 + separating]:
            ax.plot([], [], color=color, linewidth=2, label=f"stable cycle, {text}")
        ax.plot([], [], color=BLACK, linewidth=THIN, label="unstable cycle")
        handles, labels = ax.get_legend_handles_labels()
        colours = (BLACK, SEPARATED, UNSETTLED)
        up, down = ([drawing.sample(ls="", marker=way, c=colour, **SWEEP_MARK) for colour in colours] for way in "^v")
        simulated: dict[str, Any] = {"rising": up[0], "falling": down[0]}
        if separating:
            simulated["separating"] = (up[1], down[1])
        swept = np.isfinite(study["sweep_range"].values)
        if (flag_names(study["sweep_settled"])[swept] != "settled").any():
            simulated["not settled, or undecided"] = (up[2], down[2])
        handles += simulated.values()
        labels += [f"simulated, {text}" for text in simulated]
        beside = {tuple: mpl.legend_handler.HandlerTuple(None)}
        figure.legend(handles, labels, loc="outside lower center", ncols=3, handler_map=beside)
        return figure


def draw_branch(ax: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, color: str, factor: float = np.inf) -> None:
    """Draw a line along a branch, thick where it is stable, with gaps where its height jumps by more than a factor."""
    known = np.isfinite(x)
    x, y, stable = x[known], y[known], stable[known]
    height = np.log(y) if factor < np.inf else None
    ax.plot(*drawing.broken(x, y, np.log(factor), height), color=color, linewidth=THIN)
    # a segment is stable where both its ends are
    for first, last in drawing.stretches(stable[:-1] & stable[1:]):
        ax.plot(x[first : last + 1], y[first : last + 1], color=color, linewidth=2.0, solid_capstyle="butt")


def _swept(ax: Axes, x: np.ndarray, y: np.ndarray, separates: np.ndarray, settled: np.ndarray, mark: str) -> None:
    """Draw the marks of a sweep, and an arrow at each jump, by a factor of more than 10."""
    shown = np.maximum(y, LOWEST)
    for mask, color in ((settled & ~separates, BLACK), (settled & separates, SEPARATED), (~settled, UNSETTLED)):
        if mask.any():  # the layout leaves room for marks that are not clipped, even for none
            ax.plot(x[mask], shown[mask], mark, color=color, clip_on=False, **SWEEP_MARK)
    order = slice(None) if mark == "^" else slice(None, None, -1)
    x, y, jumps = x[order], shown[order], np.abs(np.diff(np.log10(np.maximum(y[order], 1e-9)))) > 1
    for i in np.flatnonzero(jumps & (y[1:] != y[:-1])):
        ax.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0})


# ---- Late in the motion
LOAD_COLOURS = (BLACK, BLUE, drawing.GREEN, drawing.PURPLE)
SMALLEST = 1e-6  # thicknesses, least range drawn: a quiet cycle moves the slider by less than a millionth of a metre


class LateRange(Plot):
    """Peak-to-peak displacement of the slider against the speed, with separation and with it ignored."""

    quantities = ("outcome",)
    named_above = True
    kind: Literal["late_range"] = "late_range"
    by: str = "disc"  # dimension with a panel for each value
    thickness: Positive = 0.002  # of the disc, m; that of the paper unless given
    not_valid: tuple[dict[str, tuple[Finite | str, ...]], ...] = ()  # points at which the law of friction does not hold
    names: dict[str, str] = Field({})  # words for values of `by`

    @property
    def dims(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("Omega", "N", "contact", self.by)

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        chosen = [("not_valid", *item) for part in self.not_valid for item in part.items()]
        for key, dim, words in (("names", self.by, self.names), *chosen):
            known = values.get(dim, ())
            for word in words:
                if dim not in self.dims or (known and word not in known):
                    yield Fault.of((key,), word, f"is no value of {dim}{suggestion(str(word), [*map(str, known)])}")

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
                    heights, words, holds = (values.sel(line).values for values in (ranges, outcomes, valid))
                    heights = np.where(holds, heights, np.nan)
                    ax.plot(speeds, heights, look, color=colour, linewidth=1.0)
                    ends, open_ends = words == "separation", np.isin(words, ["growing", "undecided"])
                    for mark, shown in ((apart, ends), (open_end, open_ends), (settled, ~(ends | open_ends))):
                        ax.plot(speeds, np.where(shown, heights, np.nan), color=colour, **mark)
            ax.margins(x=0.05)
            ax.set(yscale="log", ylim=(SMALLEST, 10), xlabel=drawing.label_of(study["Omega"])[0])
        axes[0].set_ylabel("Slider, peak to peak (thicknesses)")
        axes[0].text(0.03, 0.99, "beyond linear plate theory", transform=axes[0].transAxes, va="top", c=GREY, size=6)
        drawing.letters(axes, [self.names.get(str(name), str(name)) for name in names])
        looks: list[dict[str, Any]] = [
            *({"color": c, "label": f"{1e-3 * n:g} kN"} for n, c in zip(loads, LOAD_COLOURS, strict=False)),
            {"linestyle": "-", "label": "with separation"},
            {"linestyle": "--", "label": "separation ignored"},
            apart | {"label": "separates"},
            open_end | {"label": "growing or undecided"},
            settled | {"label": "settled in contact"},
        ]
        handles = [drawing.sample(**{"color": GREY} | look) for look in looks]
        figure.legend(handles=handles, loc="outside lower center", ncols=4, columnspacing=1.0)
        return figure


# ---- Outcomes of many starts
LOOKS = {  # of outcomes, as in maps; a hatch where another one is as dark in grey print
    "quiet": OUTCOME_LOOKS["quiet"],
    "other_cycle": OUTCOME_LOOKS["other_cycle"],
    "separating": OUTCOME_LOOKS["separation"]._replace(label="separating"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", 4 * "\\"),
    "irregular": Look("irregular", drawing.BROWN, 4 * "/"),
    **{name: OUTCOME_LOOKS[name] for name in ("steady_sliding", "at_rest", "undecided", "failed")},
}
LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a parameter."""

    kind: Literal["basins"] = "basins"
    x: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw the fractions for each energy; below, attractors by range, as large as their fractions, and energies."""
        study = study.transpose(self.x, ...)
        (label, along), energies = drawing.along(study[self.x]), study["energy"].values
        figure = drawing.new_figure(PAGE, 4.6)
        above, below = np.asarray(figure.subfigures(2, 1))
        axes = [*above.subplots(1, len(energies), sharey=True, squeeze=False)[0], *below.subplots(1, 2)]
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
        undecided = LOOKS["undecided"]._replace(label=f"undecided after {stated_in(study, 'options')['horizon']:g} s")
        handles = patches(LOOKS | {"undecided": undecided}, classes)
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
        return figure


def outcomes_in(shares: xr.DataArray) -> list[str]:
    """The outcomes that occur among the starts, in the order in which their shares are stacked."""
    return [class_ for class_ in LOOKS if (shares.sel(attractor_class=class_) > 0).any()]


def draw_shares(ax: Axes, shares: xr.DataArray, classes: Sequence[str], along: np.ndarray) -> None:
    """Draw the shares of outcomes along another dimension, stacked, as bars at the places `along`."""
    width = 0.9 * np.diff(along).min(initial=1.0)
    shares = shares.sel(attractor_class=[*classes]).transpose("attractor_class", ...)
    below = shares.cumsum("attractor_class") - shares.fillna(0)
    for class_, heights, bottoms in zip(classes, shares, below, strict=True):
        look = LOOKS[class_]
        ax.bar(along, heights, width, bottoms, fc=look.face, hatch=look.hatch, ec=BLACK, lw=0.4)
    ax.set(ylim=(0, 1))


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    study = study.transpose(..., "attractor")
    kinds, starts = flag_names(study["attractor_kind"]), study["attractor_starts"].values
    ranges = 1e3 * study["attractor_range"].values
    total = study.sizes["energy"] * study.sizes["start"]
    for class_, look in LOOKS.items():
        point, number = np.nonzero((kinds == class_) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        mark: dict[str, Any] = {"marker": "D" if look.hatch else "o", "edgecolor": BLACK, "linewidth": 0.4, "zorder": 3}
        ax.scatter(along[point], ranges[point, number], area, color=look.face, **mark)
    for part, text in ((0.1, "10 %"), (0.5, "50 %"), (1.0, "all starts")):
        ax.scatter([], [], LARGEST * part, facecolor="none", edgecolor=BLACK, linewidth=0.4, label=text)
    drawing.legend_above(ax)
    ax.set(ylabel="Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "sampled" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, bound = study["critical_energy_sampled"].values, study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="lowest separating")
    ax.plot(along, np.where(bound > 0, bound, np.nan), "v-", color=SEPARATED, markersize=3.5, label="by bisection")
    ax.set(ylabel="Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # energy 0 has no place on this logarithmic scale
        for x in along[bound == 0]:
            drawing.say(ax, "0", (x, 0), (0, 2), xycoords=("data", "axes fraction"), color=SEPARATED, fontsize=7)
    drawing.legend_above(ax, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)


# ---- Probability of instability against each uncertain parameter
MOST_PANELS = 4  # greatest number of points that a figure shows
BINS = 3  # number of parts, with equal numbers of draws, of a parameter's distribution


class Sensitivity(Plot):
    """Probability of instability in the lowest and in the highest third of each parameter; for up to four points."""

    several = True
    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            rule = f"has room for {MOST_PANELS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw rows with 95 % intervals, those above that change most; the line is the probability at all values."""
        cells = list(cells_of(study))
        names = [str(name) for name in study["parameter"].values]
        each = np.array([[probabilities(cell, name) for name in names] for _, cell in cells])
        order = np.abs(each[:, :, -1, 0] - each[:, :, 0, 0]).max(axis=0).argsort(kind="stable")
        names, rows = [names[i] for i in order], np.arange(len(names), dtype=float)
        figure, axes = panels(PAGE, 1.2 + 0.2 * len(names), 1, len(cells), sharey=True)
        for ax, (title, cell), thirds in zip(axes, cells, each[:, order], strict=True):
            ax.axvline(float(cell["probability_unstable"]), color=BLACK, linewidth=0.7, linestyle=(0, (3, 2)))
            ax.hlines(rows, thirds[:, 0, 0], thirds[:, -1, 0], color=GREY, linewidth=0.8)
            for end, up, face, label in ((0, -0.12, "white", "lowest third"), (-1, 0.12, BLUE, "highest third")):
                value, low, high = thirds[:, end].T
                look: dict[str, Any] = {"fmt": "o", "color": BLUE, "markerfacecolor": face, "markersize": 4}
                bars = np.maximum([value - low, high - value], 0.0)  # rounding
                ax.errorbar(value, rows + up, xerr=bars, elinewidth=0.8, label=f"{label} of its values", **look)
            ax.set(xlabel="P(unstable)", xlim=(-0.03, 1.03), ylim=(-0.6, len(names) - 0.4))
            ax.set_title("\n".join(title.replace("Preload ", "").replace("Speed ", "").split(", ")), loc="left")
        axes[0].set_ylabel("Parameter")
        axes[0].set_yticks(rows, labels=[typeset(presentation_of(name)[1]) or name.replace("_", " ") for name in names])
        axes[0].minorticks_off()
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return figure


def probabilities(cell: xr.Dataset, name: str) -> np.ndarray:
    """Probability of instability in each part of a parameter's values, and the ends of its interval: (parts, 3)."""
    values, words = cell["parameter_values"].sel(parameter=name).values, flag_names(cell["cycle"])
    known, unstable = words != "failed", ~np.isin(words, STABLE_CYCLES)
    edges = np.quantile(values, np.linspace(0, 1, BINS + 1))
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, BINS - 1)
    counts = [(int((unstable & known & (part == i)).sum()), int((known & (part == i)).sum())) for i in range(BINS)]
    return np.array([share(*count) for count in counts])


def cells_of(study: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Name and values of each point of the grid that has samples left, without the dimension of samples."""
    dims = [str(dim) for dim in study["status"].dims if dim != SAMPLE]
    names = [str(name) for name, values in study.coords.items() if values.dims and {*values.dims} <= {*dims}]
    for index in np.ndindex(*(study.sizes[dim] for dim in dims)):
        cell = study.isel(dict(zip(dims, index, strict=True)))
        cell = cell.isel({SAMPLE: flag_names(cell["status"]) != EXCLUDED})
        if cell.sizes[SAMPLE]:
            yield ", ".join(drawing.coordinate_text(cell[name], name) for name in names), cell
