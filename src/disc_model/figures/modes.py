"""Modes over the speed or a parameter: Campbell diagrams, complex eigenvalues of steady sliding, root loci."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BROWN, GREY, PAGE, SLIDER, Axes, Figure, Line2D, panels
from disc_model.figures.kind import NORM, Plot, Role, Roles, Values
from disc_model.figures.maps import Look, edges_of, fill, patches
from disc_model.units import Positive, Unit

COLOURS = ("#1b1046", "#7a1f4d", "#2a7fb8", "#999933", "#9fd4f2", BROWN)
"""Colours of the disc's modes by nodal diameters, distinct in grey print and from phases; from six on they repeat."""
MOST = 5  # number of peaks that are numbered at most
LEAST = 0.01  # least growth rate of a numbered peak, 1/s
HIGH = 0.5  # growth rate above which peaks are numbered even if no rise at a crossing is resolved, 1/s
DOT: dict[str, Any] = {"color": BLACK, "linestyle": "", "markersize": 3.5, "markeredgewidth": 0.5}
RING = DOT | {"markersize": 2.2, "markerfacecolor": "white"}  # looks of a numbered crossing, and of any
LINEAR = 1.0  # growth rate up to which the scale is linear, 1/s


class Campbell(Plot):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the stick-slip frequency.

    normalization : the one that is shown, where the study has several
    """

    quantities = ("campbell",)
    needs = ("Omega",)
    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = None

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Allow several normalizations if the file chooses one."""
        yield from super()._wrong_dims(values if self.normalization is None else {**values, NORM: ()})
        known = [str(word) for (word,) in values.get(NORM, ())]
        if self.normalization is not None and known and self.normalization not in known:
            yield Fault.of((NORM,), self.normalization, f"is not computed (known: {', '.join(known)})")

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw (a) frequencies, (b) growth rates by mode; events of the cycle are numbered and explained below."""
        study = study.transpose("Omega", ...)
        met = noted(study)
        heights = [3.2, 1.9, 0.13 * (1 + len(met))]
        figure, [top, bottom, below] = panels(PAGE, sum(heights) + 1.6, 3, height_ratios=heights)
        _frequencies(top, study)
        _growth_rates(bottom, study)
        for ax in (top, bottom):
            ax.set_xlim(float(study["Omega"][0]), float(study["Omega"][-1]))
            for low, high in gaps(study):
                ax.axvspan(low, high, color=GREY, alpha=0.25, linewidth=0)
            for note in met:
                ax.axvline(note.Omega, color=GREY, linewidth=0.4, zorder=0)
        _crossings(top, study, met)
        bottom.set_xlabel(drawing.axis_of("Omega")[0])
        below.set_axis_off()
        heading = "Highest peaks of the cycle's growth rate, with crossings there: mode that grows, and its rate"
        nothing = "the cycle's growth rate has no peak at a crossing"
        phrase = "\n".join([heading if met else nothing, *(f"{i}  {note.phrase}" for i, note in enumerate(met, 1))])
        below.text(0, 1, phrase, fontsize=7, va="top", transform=below.transAxes, linespacing=1.25)
        handles = [
            *mode_handles(l for l, _ in _parts(study, "sliding_frequency")),
            drawing.sample(marker=".", label="stick-slip cycle, in (a)", **DOT),
            drawing.sample(color=GREY, alpha=0.25, linewidth=6, label="no cycle found"),
            drawing.sample(marker="o", label="crossing", **RING),
            drawing.sample(marker="o", label="numbered crossing", **DOT),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=5, columnspacing=1.2)
        return figure


class Noted(NamedTuple):
    """A peak of the cycle's growth rate near crossings.

    Omega : rad/s, of the peak
    crossings : indices of the crossings in the study
    """

    Omega: float
    crossings: tuple[int, ...]
    phrase: str


def noted(study: xr.Dataset) -> list[Noted]:
    """The `MOST` highest peaks of one normalization, by speed. Peaks count from `LEAST` on at crossings at which rates
    rise, and elsewhere from `HIGH` on. One entry has all crossings of a peak, at its speed or up to the next one."""
    rate, by_mode = study["growth_rate"].values, study["cycle_growth_rate"].values
    speeds, crossed = study["Omega"].values, study["crossing_Omega"].values
    rising = np.flatnonzero(np.isin(flag_names(study["crossing_effect"]), ("rises", "destabilises")))
    peaks = [(float(study["crossing_growth_rate"][i]), [int(i)]) for i in rising]
    for first, after in drawing.stretches(np.nan_to_num(rate) > HIGH):
        index = first + int(np.argmax(rate[first:after]))
        beside = speeds[max(index - 1, 0)], speeds[min(index + 1, len(speeds) - 1)]
        crossings_beside = np.flatnonzero((beside[0] <= crossed) & (crossed <= beside[1]))
        peaks.append((float(rate[index]), crossings_beside.tolist()))
    places: dict[tuple[int, int], list[int]] = {}
    for height, crossings in peaks:
        index = int(np.nanargmin(np.abs(rate - height)))
        places.setdefault((index, int(np.nanargmax(by_mode[index]))), []).extend(crossings)
    least = LEAST * (1 - 1e-9)
    highest = sorted((peak for peak in places if by_mode[peak] >= least), key=lambda peak: by_mode[peak])[-MOST:]
    return sorted(_rise(study, *peak, sorted({*places[peak]})) for peak in highest)


def _rise(study: xr.Dataset, index: int, mode: int, crossings: list[int]) -> Noted:
    """A peak at a speed, described by the mode that leads there, which need not be that of a crossing."""
    peak = study.isel(Omega=index, mode=mode)
    texts = [f"{float(peak['Omega']):.2f} rad/s"]
    for i in crossings:
        crossing = study.isel(crossing=i)
        line = "$f_s$" if flag_names(crossing["crossing_line"]) == "stick_slip" else _TURN
        multiple, frequency = float(crossing["crossing_multiple"]), float(crossing["crossing_frequency"])
        texts.append(f"{multiple:g} {line} = {frequency:.0f} Hz")
    of_mode = f"{float(peak['sliding_frequency']):.0f} Hz mode, {float(peak['cycle_growth_rate']):.2g}/s"
    return Noted(float(peak["Omega"]), tuple(crossings), f"{', '.join(texts)}: {of_mode}")


def gaps(study: xr.Dataset) -> Iterator[tuple[float, float]]:
    """Ranges of speeds without a cycle, extended by half a step."""
    speeds = study["Omega"].values
    edges = drawing.edges(speeds)
    for first, last in drawing.stretches(~np.isfinite(study["growth_rate"].values)):
        yield float(edges[first]), float(edges[last])


_TURN = r"$f_\Omega$"


def colour_of(l: int) -> str:
    """Colour of modes with so many nodal diameters; -1: in the plane."""
    return SLIDER if l < 0 else COLOURS[l % len(COLOURS)]


def _parts(study: xr.Dataset, name: str) -> list[tuple[int, np.ndarray]]:
    """A variable by mode, cut where the nodal diameters of its number change: diameters and values, nan elsewhere."""
    kinds, diameters = flag_names(study["mode_kind"]), study["diameters"].values
    lines = []
    for i in range(study.sizes["mode"]):
        of_disc = np.where(kinds[:, i] == "disc", diameters[:, i], -1)
        present = kinds[:, i] != "none"
        for l in np.unique(of_disc[present]):
            lines.append((int(l), np.where(present & (of_disc == l), study[name].values[:, i], np.nan)))
    return lines


def _frequencies(ax: Axes, study: xr.Dataset) -> None:
    speeds = study["Omega"].values
    for l, values in _parts(study, "sliding_frequency"):
        ax.plot(speeds, values, color=colour_of(l), linewidth=0.9)
    thin = slice(None, None, max(1, len(speeds) // 40))
    for l, values in _parts(study, "cycle_frequency"):
        ax.plot(speeds[thin], values[thin], ".", color=colour_of(l), markersize=2.5)
    highest = 1.06 * float(study["sliding_frequency"].max())
    ax.set_ylim(0, highest)
    _multiples(ax, speeds, study["stick_slip_frequency"].values, highest)
    turns = study["rotation_frequency"].values
    most = int(study["diameters"].max())
    for l in range(1, most + 1):
        ax.plot(speeds, l * turns, color=GREY, linewidth=0.4, linestyle=":", zorder=0)
    if most:
        drawing.say_beside(ax, most * turns[-1] / 2, rf"{_TURN}..{most} {_TURN}" if most > 1 else _TURN)
    ax.set_ylabel("Frequency in the slider's frame (Hz)")
    ax.set_title("(a)", loc="left", pad=16)


def _multiples(ax: Axes, speeds: np.ndarray, rate: np.ndarray, highest: float) -> None:
    """Draw multiples of the stick-slip frequency, and fainter the halves between; labels stand at the panel's edge."""
    known = np.flatnonzero(np.isfinite(rate))
    if not known.size:
        return
    named = speeds[0]
    for half in range(math.floor(2 * highest / np.nanmin(rate)), 0, -1):
        n, whole = half / 2, half % 2 == 0
        look: dict[str, Any] = {"linewidth": 0.6, "linestyle": (0, (4, 2))} if whole else {"linewidth": 0.3}
        ax.plot(speeds, n * rate, color=GREY, alpha=1 if whole else 0.6, zorder=0, **look)
        if whole and n * rate[known[-1]] <= highest:
            drawing.say_beside(ax, n * rate[known[-1]], "$f_s$" if n == 1 else f"{n:g} $f_s$")
        elif whole:
            leaves = speeds[known[np.argmax(n * rate[known] > highest)]]
            if leaves - named < 0.05 * (speeds[-1] - speeds[0]):
                continue  # no room
            named = leaves
            aligned: dict[str, Any] = {"ha": "center", "va": "top", "path_effects": drawing.halo()}
            ax.text(leaves, highest, f"{n:g}", fontsize=7, color=GREY, **aligned)


def _growth_rates(ax: Axes, study: xr.Dataset) -> None:
    speeds = study["Omega"].values
    for l, values in _parts(study, "cycle_growth_rate"):
        # so large a step leads to another cycle
        ax.plot(*drawing.broken(speeds, values, LINEAR), ".-", color=colour_of(l), linewidth=0.8, markersize=1.6)
    ax.axhline(0, color=BLACK, linewidth=0.5)
    ax.set_yscale("symlog", linthresh=LINEAR, linscale=2)
    low, high = (float(end(study["cycle_growth_rate"])) for end in (np.nanmin, np.nanmax))
    ax.set_yticks([-1, -0.5, 0, 0.5, 1, 10, 100])
    ax.yaxis.set_major_formatter("{x:g}")
    ax.set_ylim(min(1.1 * low, -LINEAR), max(1.3 * high, LINEAR))
    ax.set_ylabel(f"Cycle's growth rates (1/s),\nlogarithmic beyond ±{LINEAR:g}")
    drawing.letter(ax, "b")


def _crossings(ax: Axes, study: xr.Dataset, met: list[Noted]) -> None:
    """Draw small open circles at all crossings, and full ones at those with a number above the panel."""
    ax.plot(study["crossing_Omega"], study["crossing_frequency"], "o", **RING)
    numbered = study.isel(crossing=[i for note in met for i in note.crossings])
    ax.plot(numbered["crossing_Omega"], numbered["crossing_frequency"], "o", **DOT)
    low, high = ax.get_xlim()
    places = spread([note.Omega for note in met], 0.055 * (high - low), low, high)
    for i, (note, x) in enumerate(zip(met, places, strict=True), 1):
        ax.annotate(
            str(i), (note.Omega, 1), xycoords=("data", "axes fraction"), xytext=(x, 1.03),
            textcoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=7,
            arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": GREY, "shrinkA": 0, "shrinkB": 0},
        )  # fmt: skip


def spread(places: list[float], apart: float, low: float, high: float) -> list[float]:
    """Ascending places, spread to a distance within bounds, as close as possible to the given ones."""
    from scipy.optimize import isotonic_regression

    if not places:
        return []
    apart = min(apart, (high - low) / max(len(places) - 1, 1))
    steps = apart * np.arange(len(places))
    # after subtraction of the steps, places need only not fall
    level = isotonic_regression(np.asarray(places) - steps).x
    return (np.clip(level, low, high - steps[-1]) + steps).tolist()  # type: ignore[no-any-return]


def mode_handles(diameters: Iterable[int], **look: Any) -> list[Line2D]:
    """Legend entries of the colours of modes by their nodal diameters."""
    shown = sorted({*diameters})
    names = {l: "in-plane mode" if l < 0 else f"l = {l}" for l in shown}
    return [drawing.sample(color=colour_of(l), label=name, **look) for l, name in names.items()]


# ---- Modes of steady sliding along a parameter, root loci, and what the motion really does
THIN, THICK = 0.8, 2.4  # widths of the lines of modes that decay and grow
BEGIN: dict[str, Any] = {"linestyle": "", "marker": "o", "markersize": 5, "markerfacecolor": "white"}
ROUNDING = 1e-9  # 1/s, growth rates of undamped modes by rounding


def modes_of(study: xr.Dataset) -> Iterator[tuple[int, xr.Dataset]]:
    """Each mode of a study of one point, cut where its nodal diameters change: these, -1 in the plane, and its part."""
    for _, mode in study[["frequency", "mode_growth_rate", "diameters"]].groupby("mode"):
        mode = mode.squeeze("mode")
        diameters = mode["diameters"].where(mode["frequency"].notnull())
        for l in np.unique(diameters.dropna("value")):
            yield int(l), mode.where(diameters == l)


class SlidingModes(Plot):
    """Frequencies and growth rates of steady sliding's modes along a parameter; where two meet, they coalesce.

    highest : Hz, highest frequency shown
    """

    quantities = ("sliding",)
    kind: Literal["sliding_modes"] = "sliding_modes"
    highest: Annotated[Positive, Unit("Hz")] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw (a) frequencies, (b) growth rates, by nodal diameters; thick where a mode grows. Growth at zero
        frequency belongs to no mode; it is drawn where it is the largest."""
        study = study.squeeze()
        label, factor = drawing.label_of(study["value"])
        along = study["value"].values * factor
        figure, [top, bottom] = panels(PAGE, 5.2, 2, height_ratios=[3, 2], sharex=True)
        for l, mode in modes_of(study):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            for ax, values in ((top, frequency), (bottom, rate)):
                ax.plot(along, values, ".-", color=colour_of(l), linewidth=THIN, markersize=1.2)
                x, y = (np.where(rate > ROUNDING, coordinates, np.nan) for coordinates in (along, values))
                ax.plot(x, y, ".-", color=colour_of(l), linewidth=THICK, markersize=3)
        largest = study["largest_growth_rate"]
        diverging = (largest > study["mode_growth_rate"].max("mode") + ROUNDING).values
        for ax, values in ((top, np.zeros(along.size)), (bottom, largest.values)):
            ax.plot(along, np.where(diverging, values, np.nan), ".-", color=BLACK, linewidth=THICK, markersize=3)
        bottom.axhline(0, color=BLACK, linewidth=0.5)
        top.set(ylabel="Frequency in the slider's frame (Hz)", xlim=(along[0], along[-1]))
        if self.highest is not None:
            top.set_ylim(0, self.highest)
        # the sign matters: decay of high modes may be much faster
        low, top_rate = float(study["mode_growth_rate"].min()), max(float(largest.max()), 0.1)
        bottom.set(xlabel=label, ylabel="Growth rate (1/s)", ylim=(max(1.1 * low, -2 * top_rate), 1.1 * top_rate))
        drawing.letters([top, bottom])
        handles = [*mode_handles(l for l, _ in modes_of(study)), drawing.sample(color=GREY, lw=THICK, label="grows")]
        if diverging.any():
            handles.append(drawing.sample(color=BLACK, lw=THICK, label="grows at zero frequency"))
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), columnspacing=1.2)
        return figure


class RootLocus(Plot):
    """Eigenvalues of steady sliding in the plane of growth rate and frequency, coloured along the parameter."""

    quantities = ("sliding",)
    kind: Literal["root_locus"] = "root_locus"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw points for each mode, with a ring where it begins."""
        from cmcrameri import cm

        study = study.squeeze()
        label, factor = drawing.label_of(study["value"])
        along = study["value"].values * factor
        figure, [ax] = panels(PAGE, 3.8)
        for l, mode in modes_of(study):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            ax.plot(rate[:1], frequency[:1], color=colour_of(l), **BEGIN)
            points = ax.scatter(rate, frequency, c=along, cmap=cm.batlow, vmin=along[0], vmax=along[-1], s=5, zorder=2)
        ax.axvline(0, color=BLACK, linewidth=0.6)
        ax.set(xlabel="Growth rate (1/s)", ylabel="Frequency in the slider's frame (Hz)")
        figure.colorbar(points, ax=ax, label=label, pad=0.01, aspect=30)
        handles = mode_handles((l for l, _ in modes_of(study)), **BEGIN)
        figure.legend(handles=handles, loc="outside lower center", ncols=7)
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
        shares = {word: f"{AGREEMENTS[word].label} ({count / total:.0%})" for word, count in used.items()}
        looks = {word: look._replace(label=shares[word]) for word, look in AGREEMENTS.items() if word in used}
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
