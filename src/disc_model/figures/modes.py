"""Modes over the speed or a parameter: Campbell diagrams, complex eigenvalues of steady sliding, root loci."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.errors import Fault, suggestion
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, GREY, PAGE, Figure, cm, panels
from disc_model.figures.general import LINEAR, scale_rates
from disc_model.figures.kind import NORM, Plot, Role, Roles, Values
from disc_model.figures.maps import OUTCOME_LOOKS, Look, edges_of, fill, patches
from disc_model.units import Positive, Unit

MOST = 5  # number of peaks that are named at most
NEAR = 0.01  # share of the speeds shown within which peaks are one, and crossings belong to a peak
DOT: dict[str, Any] = {"color": BLACK, "linestyle": "", "marker": "o", "markersize": 3.5}
HOLLOW: dict[str, Any] = {"markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.7}


class Campbell(Plot):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the stick-slip frequency."""

    needs = ("Omega",)
    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = None  # the one shown, where the study has several

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        yield from super()._wrong_dims(values if self.normalization is None else {**values, NORM: ()})
        known = values.get(NORM, ())
        if self.normalization is not None and known and self.normalization not in known:
            yield Fault.of((NORM,), self.normalization, f"is not computed{suggestion(self.normalization, known)}")

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
            multiple, symbol, line = float(crossing["crossing_multiple"]), "f_Ω", study["rotation_frequency"]
            if flag_names(crossing["crossing_line"]) == "stick_slip":
                symbol, line = "f_s", study["stick_slip_frequency"]
            top.plot(speeds, multiple * line, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)), zorder=0)
            meeting = float(crossing["crossing_Omega"]), float(crossing["crossing_frequency"])
            top.plot(*meeting, **DOT)
            drawing.say(top, f"{multiple:g} ${symbol}$", meeting, (4, -1), **beside | {"fontsize": 6})
            drawing.say(bottom, f"{multiple:g} ${symbol}$", (speeds[i], rate[i]), (2, 3), **beside)
        for ax in (top, bottom):
            for low, high in drawing.spans(speeds, ~np.isfinite(rate)):  # without a cycle
                ax.axvspan(low, high, color=GREY, alpha=0.25, linewidth=0)
        low, high = (float(end.reduce(rate, initial=0.0)) for end in (np.fmin, np.fmax))
        bottom.set(ylim=(min(1.3 * low, -LINEAR), max(3 * high, LINEAR)), xlabel=drawing.axis_of("Omega")[0])
        bottom.set_ylabel("Largest growth rate\nof the cycle (1/s)")
        top.set(xlim=speeds[[0, -1]], ylim=(0, highest), ylabel="Frequency in the slider's frame (Hz)")
        drawing.letters([top, bottom])
        return figure


def peaks(study: xr.Dataset) -> Iterator[tuple[int, xr.Dataset | None]]:
    """The `MOST` highest peaks of the cycle's growth rate from `LINEAR` on: index of the speed, and the nearest
    crossing, of the leading mode if possible; without points by themselves beside gaps, which are of another cycle."""
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
        yield int(i), study.isel(crossing=int(distance.argmin())) if np.isfinite(distance).any() else None


def unjoined(rate: np.ndarray) -> np.ndarray:
    """Points whose growth rate differs by more than `LINEAR` from those of both neighbours."""
    joined = np.concatenate([[False], np.abs(np.diff(rate)) <= LINEAR, [False]])
    return np.isfinite(rate) & ~(joined[:-1] | joined[1:])


def name_of(*diameters: int) -> str:
    """Name of modes by their nodal diameters; -1: in the plane."""
    numbers = [str(l) for l in sorted({*diameters}) if l >= 0]
    return ", ".join(["in-plane"] * (min(diameters) < 0) + [f"l = {', '.join(numbers)}"] * bool(numbers))


def named_modes(diameters: np.ndarray, heights: np.ndarray, apart: float) -> Iterator[tuple[np.ndarray, str]]:
    """Indices of modes, ascending by height, and their names; those nearer than `apart` to the one below share one."""
    known = np.argsort(heights)[: int(np.isfinite(heights).sum())]
    for part in np.split(known, np.flatnonzero(np.diff(heights[known]) > apart) + 1):
        if part.size:
            yield part, name_of(*diameters[part].tolist())


# ---- Modes of steady sliding along a parameter, root loci, and what the motion really does
THIN, THICK = 0.8, 2.4  # widths of the lines of modes that decay and grow
ROUNDING = 1e-9  # 1/s, growth rates of undamped modes by rounding


class SlidingModes(Plot):
    """Frequencies and growth rates of steady sliding's modes along a parameter; where two meet, they coalesce."""

    quantities = ("sliding",)
    kind: Literal["sliding_modes"] = "sliding_modes"
    highest: Annotated[Positive, Unit("Hz")] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw lines, thick where a mode grows. Growth at 0 Hz is of no mode, and drawn where it is the largest."""
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
            for l in np.unique(diameters[np.isfinite(diameters)]):  # the mode is cut where its nodal diameters change
                lines.append((name_of(int(l)), *(np.where(diameters == l, x, np.nan) for x in (frequency, rate))))
        all_rates = np.array([rate for *_, rate in lines])
        at_zero = [np.where(diverging, values, np.nan) for values in (0 * largest, largest)]
        for name, frequency, rate in (*lines, ("0 Hz", *at_zero)):
            grows = np.nan_to_num(rate) > ROUNDING
            for ax, values in ((top, frequency), (bottom, rate)):
                ax.plot(along, values, ".-", color=GREY, linewidth=THIN, markersize=1.2)
                ax.plot(along, np.where(grows, values, np.nan), ".-", color=BLACK, linewidth=THICK, markersize=3)
            for start, after in drawing.stretches(grows[:-1] & grows[1:]):
                shown = slice(start, after + 1)  # the name is where there is room above, and else at the largest rate
                above = all_rates[:, shown] - rate[shown]
                room = np.where(above > 0, above, np.inf).min(axis=0, initial=0.25 * float(largest.max()))
                i = start + int(np.lexsort((rate[shown], room))[-1])
                offset = (3, 0) if i == along.size - 1 else (0, 3)
                drawing.say(bottom, name, (along[i], rate[i]), offset, fontsize=7, path_effects=drawing.halo())
        bottom.axhline(0, color=BLACK, linewidth=0.5)
        highest = self.highest or top.get_ylim()[1]
        top.set(ylabel="Frequency in the slider's frame (Hz)", xlim=along[[0, -1]], ylim=(0, highest))
        first = study.isel(value=0)
        for part, name in named_modes(first["diameters"].values, first["frequency"].values, 0.04 * highest):
            left_end = along[0], float(first["frequency"][part].mean())
            drawing.say(top, name, left_end, (3, 0), fontsize=7, bbox={"fc": "white", "lw": 0, "pad": 1})
        # the sign matters: decay of high modes may be much faster
        low, top_rate = float(study["mode_growth_rate"].min()), max(float(largest.max()), 0.1)
        bottom.set(xlabel=label, ylabel="Growth rate (1/s)", ylim=(max(1.1 * low, -top_rate), 1.1 * top_rate))
        last = study.isel(value=-1)
        decay = last["mode_growth_rate"].where(lambda rates: (rates < -ROUNDING) & (rates > -top_rate)).values
        for part, name in named_modes(last["diameters"].values, decay, 0.1 * top_rate):
            drawing.say_beside(bottom, float(decay[part].mean()), name, 3, fontsize=7, color=GREY)
        drawing.letters([top, bottom])
        return figure


class RootLocus(Plot):
    """Eigenvalues of steady sliding in the plane of growth rate and frequency, coloured along the parameter."""

    quantities = ("sliding",)
    kind: Literal["root_locus"] = "root_locus"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw points, with a ring where a mode begins, and its name on the side from which it leads away."""
        study = study.squeeze()
        label, along = drawing.along(study["value"])
        figure, [ax] = panels(PAGE, 4.8)
        for _, mode in study.groupby("mode"):
            rate, frequency = mode["mode_growth_rate"].values, mode["frequency"].values
            points = ax.scatter(rate, frequency, c=along, cmap=cm.batlow, vmin=along[0], vmax=along[-1], s=5, zorder=2)
        first = study.isel(value=0)
        rates, heights = first["mode_growth_rate"].values, first["frequency"].values
        ax.plot(rates, heights, "o", color=BLACK, markersize=4, markerfacecolor="white")
        ahead = study["mode_growth_rate"].isel(value=1).values - rates
        letter_width = 0.0136 * float(study["mode_growth_rate"].max() - study["mode_growth_rate"].min())
        for part, name in named_modes(first["diameters"].values, heights, 0.01 * float(study["frequency"].max())):
            side, ring = (-1, rates[part].min()) if ahead[part].mean() > 0 else (1, rates[part].max())
            if side > 0 and -letter_width * len(name) < ring < 0:  # the name would cross the line of zero growth
                side, ring = -1, float(study["mode_growth_rate"].isel(mode=part).min())
            drawing.say(ax, name, (ring, heights[part].mean()), (4 * side, 0), fontsize=7, path_effects=drawing.halo())
        ax.axvline(0, color=BLACK, linewidth=0.6)
        ax.margins(x=0.02)
        ax.set(xlabel="Growth rate (1/s)", ylabel="Frequency in the slider's frame (Hz)")
        figure.colorbar(points, ax=ax, label=label, pad=0.01, aspect=30)
        return figure


AGREEMENTS = {  # what linear analysis of steady sliding says (dots: stable), and what the motion from the start does
    "stable_quiet": Look("stable, and the motion quiet", OUTCOME_LOOKS["quiet"].face, 3 * "."),
    "stable_grows": Look(
        "stable, but the motion leaves the quiet cycle in contact", OUTCOME_LOOKS["growing"].face, 3 * "."
    ),
    "stable_separates": Look("stable, but the motion separates", OUTCOME_LOOKS["separation"].face, 3 * "."),
    "unstable_quiet": Look("unstable, but the motion stays quiet", OUTCOME_LOOKS["quiet"].face),
    "unstable_grows": Look(
        "unstable, and the motion grows, or reaches another cycle, in contact", OUTCOME_LOOKS["growing"].face
    ),
    "unstable_separates": Look("unstable, and the motion separates", OUTCOME_LOOKS["separation"].face),
    "unknown": Look("undecided, or no steady sliding", OUTCOME_LOOKS["undecided"].face),
}


class SlidingOutcome(Plot):
    """What linear analysis says of steady sliding beside what the motion does, over two parameters."""

    quantities = ("regions", "outcome")
    several = True
    named_above = True
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
            linear = drawing.of(overlays["sliding"], norm).rename(value=self.x).transpose(self.y, self.x, ...)
            plane, linear = common_points(plane, linear, (self.x, self.y))
            words = agreement(linear["largest_growth_rate"].values, flag_names(plane["outcome"]))
            fill(ax, edges_of(plane["outcome"]), words, AGREEMENTS)
            each.append(words)
            ax.set(xlabel=drawing.axis_of(self.x)[0], ylabel=drawing.axis_of(self.y)[0])
            ax.label_outer()
        drawing.letters(axes, [drawing.MODES[norm] for norm in norms])
        names, looks = ("(a) ", "(b) ") if len(each) > 1 else ("",), {}
        for word, look in AGREEMENTS.items():
            shares = [
                f"{letter}{100 * np.mean(words == word):.0f} %" for letter, words in zip(names, each, strict=False)
            ]
            looks[word] = look._replace(label=f"{look.label}: {', '.join(shares)}")
        handles = patches(looks, {*np.concatenate(each, axis=None)})
        figure.legend(handles=handles, loc="outside lower center", ncols=1, title="Steady sliding is")
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
