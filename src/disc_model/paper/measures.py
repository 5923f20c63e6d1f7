"""Numbers that the rows of the ledger measure, from events and samples, and their words."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis import spectra
from disc_model.analysis.classify import FEWEST, Motion, Settled, Settling, motion_of, settling
from disc_model.analysis.spectra import Line
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import (
    EVENT_KINDS,
    PHASES,
    STATUSES,
    flag_names,
    stated_in,
    values_text,
)
from disc_model.display import counted
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.cycle import floquet
from disc_model.stability.sliding import steady_sliding

Array = NDArray[np.float64]
SEPARATION = PHASES.index("separation")
STRETCHES, STRETCH = 3, 20.0  # number and length of the last stretches of a case, s
STEADY = 3e-4  # 1/s: a motion is steady if its ranges of contact force and disc change more slowly
LOW, HIGH = (
    20.0,
    700.0,
)  # Hz: above the drive's line and its multiples; above the disc's highest natural frequency


class Absent(Missing):
    """The evidence exists but lacks the feature that a row states: it is false."""


class Range(NamedTuple):
    """Least and greatest value; formatted as ``low to high``, or as one number."""

    low: float
    high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    def __format__(self, spec: str) -> str:
        return f"{self.low:{spec}}" + (f" to {self.high:{spec}}" if self.high != self.low else "")


@dataclass(frozen=True)
class CaseView:
    """View of one case, or of a grid study; raises `Missing` where the case does not hold what is
    asked for."""

    name: str
    node: xr.DataTree

    def __getitem__(self, name: str) -> float:
        """A scalar: a parameter, or one of `disc_model.data.variables.SCALARS`."""
        return float(self.node.variables[name].values)  # node[name] would make a dataset

    @cached_property
    def parameters(self) -> Parameters:
        return Parameters.model_validate_json(self.node.attrs["parameters"])

    @property
    def status(self) -> str:
        return STATUSES[int(self["status"])]

    @property
    def separates(self) -> bool:
        return self["n_separations"] > 0

    @property
    def is_grid(self) -> bool:
        return "parameters" not in self.node.attrs

    @property
    def bonded(self) -> bool:
        """Whether separation is ignored."""
        return self.parameters.contact == "bilateral"

    @property
    def from_rest(self) -> bool:
        return "start" not in self.node.attrs

    @property
    def place(self) -> str:
        """Preload and speed, and what else differs from Table 1, in words."""
        p = self.parameters
        others = {name: x for name, x in p if name not in ("N", "Omega") and not isinstance(x, str)}
        return ", ".join(filter(None, [place(p.N, p.Omega), values_text(others)]))

    @property
    def drive(self) -> float:
        """Frequency of the drive, Hz."""
        return self["Omega"] / (2 * np.pi)

    @property
    def contact(self) -> str:
        """For how long contact is kept, in words."""
        time, end = self["first_separation"], self["time_reached"]
        return (
            f"contact is kept for {end:g} s"
            if math.isnan(time)
            else f"contact is lost at {time:.2f} s"
        )

    @property
    def contact_and_growth(self) -> str:
        """The same, and how disturbances of its cycle grow."""
        growth = rate_text(
            self.growth_rate,
            "/s",
            "not defined, because no cycle was found near static equilibrium",
        )
        return f"{self.contact}, and growth is {growth}"

    @property
    def fate(self) -> str:
        """The same as a sentence, with the place."""
        return f"At {self.place}, {self.contact_and_growth}."

    @cached_property
    def late_motion(self) -> Motion:
        """Class of the in-plane motion within the stored events."""
        return motion_of(self.intervals())

    @property
    def motion(self) -> str:
        """The same in words."""
        times, motion = self.intervals(), self.late_motion
        if not motion.period:
            most = (
                f"{motion}: it does not repeat after any number of releases up to {times.size // 2}"
            )
            return f"{most}, and the 0-1 test for chaos gives {motion.chaos:.2f}"
        length = float(times[: motion.period].sum())
        apart = round(self.rate_of("separation") * length)
        after = counted(motion.period, "release") + (
            f" and {counted(apart, 'separation')}" if apart else ""
        )
        return f"periodic: it repeats after {after}, every {length:.6g} s"

    @property
    def early(self) -> Range:
        """Range of the contact force from 1 to 21 s, N."""
        return self.range_of("P", 1.0, 1.0 + STRETCH)

    @property
    def late(self) -> Range:
        """Range of the contact force over the last 20 s, N."""
        return self.late_range("P")

    @property
    def disc(self) -> Range:
        """Range of the disc's point over the last 20 s, m."""
        return self.late_range("w_point")

    @property
    def stick(self) -> float:
        """Fraction of time in stick, within the stored events."""
        return self.phase_share("stick")

    @property
    def stick_in_all(self) -> float:
        """Fraction of time in stick, of the whole run."""
        return self["time_stick"] / self["time_reached"]

    @property
    def growth_rate(self) -> float:
        return growth_of(self.parameters)

    @cached_property
    def events(self) -> xr.Dataset:
        return self._held(dataset.events)

    @cached_property
    def history(self) -> xr.Dataset:
        """Least and greatest values of variables within the bins of the window `history`."""
        return self._held(dataset.samples, "history", 1, envelope=True)

    def samples(self, window: str) -> xr.Dataset:
        """Samples of a window, or of the section ``poincare``."""
        return self._held(dataset.samples, window)

    def _held(self, ask: Callable[..., xr.Dataset], *args: Any, **options: Any) -> xr.Dataset:
        try:
            return ask(self.node, *args, **options)
        except Missing as reason:
            raise Missing(f"case {self.name} {reason}") from None

    def range_of(self, name: str, start: float, stop: float) -> Range:
        """Range of a variable from the whole bins of the history between two times, s."""
        time = self.history["time"].values
        half = (
            (time[1] - time[0]) / 2 if time.size > 1 else np.inf
        )  # the width of a single bin is unknown
        inside = (time >= start + 0.99 * half) & (time <= stop - 0.99 * half)
        if not inside.any():
            raise Missing(f"case {self.name} has no history from {start:g} to {stop:g} s")
        low, high = (self.history[f"{name}_{end}"].values[inside] for end in ("min", "max"))
        return Range(float(low.min()), float(high.max()))

    def late_range(self, name: str) -> Range:
        """Range over the last 20 s of the run."""
        return self.range_of(name, self["time_reached"] - STRETCH, self["time_reached"])

    def last_widths(self, name: str, length: float, count: int) -> list[float]:
        """Widths of a variable's ranges over stretches of a length, s, up to the end, the last one
        first."""
        end = self["time_reached"]
        return [
            self.range_of(name, end - (i + 1) * length, end - i * length).width
            for i in range(count)
        ]

    def last_quarters(self, name: str) -> list[float]:
        """Widths over the last two quarters of the time after the first separation."""
        return self.last_widths(name, (self["time_reached"] - self["first_separation"]) / 4, 2)

    def settling(self) -> Settling:
        """Whether the ranges of contact force and disc have settled, over the run and over its last
        stretches, in which alone a change that has just begun shows."""
        whole = self.history.isel(time=slice(None, -1))  # the last bin is cut
        late = whole.sel(time=slice(self["time_reached"] - STRETCHES * STRETCH, None))
        whole_and_late = [
            settling(
                part["time"].values,
                (part[f"{name}_max"] - part[f"{name}_min"]).values,
                STEADY,
                still=1.0,
            )
            for part in (whole, late)
            for name in ("P", "w_point")
        ]
        moving = [each for each in whole_and_late[2:] if each.answer is Settled.CHANGING]
        return min(moving or whole_and_late[:2], key=lambda each: [*Settled].index(each.answer))

    def switches(self, kind: str) -> xr.Dataset:
        """The stored events of one kind."""
        return self.events.isel(event=self.events["kind"].values == EVENT_KINDS.index(kind))

    def times_of(self, kind: str) -> Array:
        return np.asarray(self.switches(kind)["time"])

    def intervals(self, kind: str = "stick_to_slip") -> Array:
        """Times between successive releases, or separations, among the stored events, s."""
        intervals = np.diff(self.times_of(kind))
        if intervals.size < FEWEST:
            what = "stick-slip cycles" if kind == "stick_to_slip" else f"{kind}s"
            raise Missing(f"case {self.name} keeps fewer than {FEWEST} {what}")
        return intervals

    def rate_of(self, kind: str) -> float:
        """Rate of one kind of event within the stored events, 1/s."""
        return self.times_of(kind).size / self.kept_span.width

    @property
    def kept_span(self) -> Range:
        """Span of time for which a case stores its events, s."""
        attrs = self.events.attrs
        return Range(
            float(attrs["kept_from"]), min(float(attrs["kept_until"]), self["time_reached"])
        )

    @property
    def longest_separation(self) -> float:
        """Longest of the separations that begin within the stored events, s; one that lasts counts
        to their end."""
        apart, together = self.times_of("separation"), self.times_of("reattachment")
        ends = np.searchsorted(together, apart, side="right")
        whole = ends < together.size
        if not whole.any():
            raise Missing(f"case {self.name} keeps no whole separation")
        longest = float((together[ends[whole]] - apart[whole]).max())
        return longest if whole.all() else max(longest, self.kept_span.high - float(apart[-1]))

    def phase_share(self, phase: str) -> float:
        """Fraction of time spent in a phase, within the stored events."""
        lasting = np.diff(np.append(self.events["time"].values, self.kept_span.high))
        spent = lasting[self.events["phase"].values == PHASES.index(phase)]
        return ratio(
            float(spent.sum()),
            float(lasting.sum()),
            f"the time that events of case {self.name} cover",
        )

    def signal(self, window: str, start: float, stop: float, name: str = "w_point") -> "Signal":
        """A variable between two times, from the samples of a window."""
        samples = self.samples(window).sel(time=slice(start, stop))
        if samples.sizes["time"] < 100:
            raise Missing(
                f"case {self.name} has no samples in {window} from {start:g} to {stop:g} s"
            )
        return Signal(self.name, window, samples["time"].values, samples[name].values)

    def slope(self, name: str, start: float, stop: float) -> float:
        """Mean rate at which the logarithm of a variable's range grows between two times, 1/s."""
        part = self.history.sel(time=slice(start, stop))
        if part.sizes["time"] < 4:
            raise Missing(f"case {self.name} has no history from {start:g} to {stop:g} s")
        width = part[f"{name}_max"].values - part[f"{name}_min"].values
        if not width.min() > 0:
            raise Missing(
                f"case {self.name} has no vibration in {name} from {start:g} to {stop:g} s"
            )
        return float(np.polyfit(part["time"].values, np.log(width), 1)[0])


class Signal(NamedTuple):
    """Samples of a case between two times, s; fractions are comparable for stretches of equal
    length only."""

    case: str
    window: str
    time: Array
    values: Array

    @property
    def filled(self) -> float:
        """Fraction of 20..300 Hz where the amplitude exceeds 1e-4 of the strongest: fuzz fills it,
        lines do not."""
        return spectra.coverage(self.time, self.values, LOW, 300.0, floor=1e-4)

    def power_above(self, frequency: float) -> float:
        """Ratio of the power above a frequency in Hz to that above `LOW`; raises `Missing` without
        any line."""
        self.lines(above=LOW)
        return spectra.power_share(self.time, self.values, frequency, LOW)

    def lines(self, count: int | None = None, **options: float) -> list[Line]:
        """Lines, as by `disc_model.analysis.spectra`, the strongest ones of a count; raises
        `Missing` without any."""
        peaks = spectra.lines(self.time, self.values, **options)
        if not peaks:
            raise Missing(f"case {self.case} has no line in the spectrum of {self.window}")
        return sorted(peaks, key=lambda line: -line.amplitude)[:count] if count else peaks

    def strongest(self, near: float, within: float) -> Line:
        """The strongest line within `within` Hz of a frequency; raises `Absent`."""
        try:
            return spectra.strongest(self.time, self.values, near, within)
        except ValueError as error:
            raise Absent(f"case {self.case}: {error} in w_point") from None


def views(trees: Mapping[str, xr.DataTree]) -> dict[str, CaseView]:
    """Views of the merged cases, which bear the name ``cases``, and of grid studies, by name."""
    nodes = {**trees["cases"].children, **trees}
    return {name: CaseView(name, node) for name, node in nodes.items() if name != "cases"}


def pairs(cases: Sequence[CaseView]) -> list[tuple[CaseView, CaseView]]:
    """Cases with separation, each with the case that ignores separation; raises `Missing` if one
    has no such case."""
    bonded = {case.parameters: case for case in cases if case.bonded}
    free = [
        (case, case.parameters.replace(contact="bilateral")) for case in cases if not case.bonded
    ]
    if alone := [case.name for case, p in free if p not in bonded]:
        raise Missing(
            f"without separation there is no case with the parameters of {', '.join(alone)}"
        )
    return [(case, bonded[p]) for case, p in free]


def ratio(part: float, whole: float, what: str) -> float:
    """Ratio of two numbers; raises `Missing` if the denominator, which is `what`, is zero."""
    if not whole > 0:
        raise Missing(f"{what} is {whole:g}")
    return part / whole


def width_ratio(case: CaseView, bonded: CaseView) -> float:
    """Range of the disc in the end with separation over that without."""
    return ratio(case.disc.width, bonded.disc.width, f"the range of the disc in case {bonded.name}")


# ---- Grid studies
def published(study: xr.Dataset) -> xr.Dataset:
    return study.sel(normalization="as_published")


def sound(study: xr.Dataset) -> xr.Dataset:
    """The grid study; raises `Missing` if a point failed."""
    by_outcome = "outcome" in study
    words = flag_names(study["outcome" if by_outcome else "status"])
    if np.any(words == "failed" if by_outcome else words != "ok"):
        raise Missing(f"study {study.attrs.get('study', '')} has points that failed")
    return study


def facts(study: xr.Dataset) -> dict[str, Any]:
    """What sentences say of a grid study: its base values, its options, and how far each axis of
    numbers extends."""
    axes = {
        str(name): extent(axis) for name, axis in study.indexes.items() if axis.dtype.kind in "if"
    }
    return stated_in(study, "base") | stated_in(study, "options") | axes


# ---- Numbers in words
def extent(values: Iterable[float]) -> Range:
    numbers = np.asarray([*values])
    return Range(float(numbers.min()), float(numbers.max()))


def repeats(motion: Motion, name: str) -> str:
    """After how many events of this name a motion repeats, or else its class, in words."""
    return f"repeats after {counted(motion.period, name)}" if motion.period else f"is {motion}"


def place(N: float, Omega: float) -> str:
    return f"{N:g} N, {Omega:g} rad/s"


def or_none(value: float, spec: str, unit: str = "", without: str = "none") -> str:
    """A number with its unit, or a text if it is missing."""
    return without if math.isnan(value) else f"{value:{spec}}{unit}"


def rate_text(rate: float, unit: str = "", without: str = "no cycle") -> str:
    """A growth rate as text, or a text if there is no cycle."""
    return or_none(rate, "+.4f", unit, without)


# ---- Computed for the rows
@cache
def growth_of(p: Parameters) -> float:
    """Largest growth rate of small disturbances of the stick-slip cycle near the static start, 1/s;
    nan without one."""
    return floquet(p).growth_rate


@cache
def sliding_growth(p: Parameters) -> float:
    """Largest growth rate of small disturbances of steady sliding, 1/s; nan without an
    equilibrium."""
    return steady_sliding(p).growth_rate


@cache
def separates_within(p: Parameters, until: float) -> bool:
    """Whether the static start separates before a time in s, in a simulation of its own."""
    return math.isfinite(
        simulate(p, until, stop_at="first_separation").raise_for_status().first_separation
    )
