"""Views of cases and grid studies, with what rows of the ledger measure in a case, and its words."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis import classify, spectra
from disc_model.analysis.classify import FEWEST, Motion, Settled, Settling
from disc_model.arrays import Array
from disc_model.data import dataset, variables
from disc_model.data.dataset import Missing
from disc_model.display import counted
from disc_model.parameters import Parameters
from workflow.paper import growth, signals

SEPARATION = variables.PHASES.index("separation")

STRETCHES = 3
"""Number of the last stretches of a case that are compared."""
STRETCH = 20.0
"""Length of such a stretch, s."""
SAMPLING = 1.02
"""Factor by which the range of a steady contact force may differ; sampling adds far less."""
PLACE = 1e-4
"""Share of their range by which points of a section must differ to lie at different places.

A motion that repeats comes back far closer. Neighbours among 500 points of a closed curve are on
average some fifty times farther apart, so that a curve is not taken for a few places.
"""
STEADY = 3e-4
"""Greatest rate in 1/s at which the ranges of contact force and disc of a steady motion change."""

LOW = 20.0
"""Hz, above the drive's line and its multiples."""
HIGH = 700.0
"""Hz, above the disc's highest natural frequency."""

FEWEST_SAMPLES = 100
"""Samples below which a stretch of a window is not looked at."""
FEWEST_BINS = 4
"""Bins of the history below which no slope is fitted."""


Found = dict[str, Any]
"""What is measured, by name."""


class Absent(Missing):
    """The evidence exists but lacks the feature that a row states: the statement is false."""


class Range(NamedTuple):
    """Least and greatest value; formatted as ``low to high``, or as one number if they are equal."""

    low: float
    high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    def __format__(self, spec: str) -> str:
        if self.high == self.low:
            return f"{self.low:{spec}}"
        return f"{self.low:{spec}} to {self.high:{spec}}"


@dataclass(frozen=True)
class CaseView:
    """View of one case, or of a grid study.

    Its members raise `Missing` where the case does not hold what they need.
    """

    name: str
    node: xr.DataTree

    def __getitem__(self, name: str) -> float:
        """Return a scalar: a parameter, or one of `disc_model.data.variables.SCALARS`."""
        if name in Parameters.model_fields:
            return getattr(self.parameters, name)
        return float(self.node.variables[name])  # node[name] would make a dataset

    # ---- What the case is

    @cached_property
    def parameters(self) -> Parameters:
        return Parameters.model_validate_json(self.node.attrs["parameters"])

    @property
    def status(self) -> str:
        return variables.STATUSES[int(self["status"])]

    @property
    def separates(self) -> bool:
        return self["n_separations"] > 0

    @property
    def loss(self) -> float:
        """Time of the first separation, s; raises `Absent` if there is none."""
        if not self.separates:
            raise Absent(f"case {self.name}: no separation in {self['time_reached']:g} s")
        return self["first_separation"]

    @property
    def is_grid(self) -> bool:
        return "parameters" not in self.node.attrs

    @property
    def bilateral(self) -> bool:
        """Whether separation is ignored."""
        return self.parameters.contact == "bilateral"

    @property
    def from_rest(self) -> bool:
        return "start" not in self.node.attrs

    @property
    def drive(self) -> float:
        """Frequency of the drive, Hz."""
        return self["Omega"] / (2 * np.pi)

    @property
    def growth_rate(self) -> float:
        """Growth rate of small disturbances of the cycle near the static start, 1/s."""
        return growth.growth_of(self.parameters)

    @property
    def frictionless_growth(self) -> float:
        """Growth rate of steady sliding without friction, 1/s."""
        return growth.sliding_growth(self.parameters.replace(mu_s=0.0, mu_k=0.0))

    # ---- Words

    @property
    def place(self) -> str:
        """Preload and speed, and what else differs from Table 1, in words."""
        p = self.parameters
        others = {
            name: value
            for name, value in p
            if name not in ("N", "Omega") and not isinstance(value, str)
        }
        parts = [place(p.N, p.Omega), variables.values_text(others)]
        return ", ".join(filter(None, parts))

    @property
    def contact(self) -> str:
        """How long contact is kept, in words."""
        first = self["first_separation"]
        if math.isnan(first):
            return f"contact is kept for {self['time_reached']:g} s"
        return f"contact is lost at {first:.2f} s"

    @property
    def contact_and_growth(self) -> str:
        """How long contact is kept, and how disturbances of the cycle grow, in words."""
        no_cycle = "not defined, because no cycle was found near static equilibrium"
        return f"{self.contact}, and growth is {rate_text(self.growth_rate, '/s', no_cycle)}"

    @property
    def fate(self) -> str:
        """Place, contact and growth, as a sentence."""
        return f"At {self.place}, {self.contact_and_growth}."

    @property
    def steadiness(self) -> str:
        """The same with ranges of the contact force where contact is kept, if they are stored."""
        if self.separates or "history" not in self.node:
            return self.fate
        return (
            f"{self.fate} The range of the contact force is {self.early.width:.2f} N between 1 and "
            f"21 s, and {self.late.width:.2f} N in the last 20 s."
        )

    @property
    def motion(self) -> str:
        """Class of the in-plane motion within the stored events, in words."""
        intervals = self.intervals()
        motion = self.late_motion
        if not motion.period:
            most = intervals.size // 2
            return (
                f"{motion}: it does not repeat after any number of releases up to {most}, "
                f"and the 0-1 test for chaos gives {motion.chaos:.2f}"
            )
        length = self.period_length
        events = counted(motion.period, "release")
        separations = round(self.rate_of("separation") * length)
        if separations:
            events += f" and {counted(separations, 'separation')}"
        return f"periodic: it repeats after {events}, every {length:.6g} s"

    # ---- Ranges

    @property
    def calm(self) -> bool:
        """Whether contact is kept, and the contact force has no wider range in the end.

        Where ranges are not stored, it is whether contact is kept.
        """
        if self.separates or "history" not in self.node:
            return not self.separates
        return not SAMPLING * self.early.width < self.late.width

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

    @cached_property
    def history(self) -> xr.Dataset:
        """Least and greatest values of variables within the bins of the window ``history``."""
        return self._stored("history")

    def range_of(self, name: str, start: float, stop: float) -> Range:
        """Return the range of a variable in the whole bins of the history between two times, s."""
        time = self.history["time"].values
        half_bin = np.inf  # the width of a single bin is unknown
        if time.size > 1:
            half_bin = (time[1] - time[0]) / 2
        margin = 0.99 * half_bin
        inside = self.history.sel(time=slice(start + margin, stop - margin))
        if not inside.sizes["time"]:
            raise Missing(f"case {self.name} has no history from {start:g} to {stop:g} s")
        return Range(float(inside[f"{name}_min"].min()), float(inside[f"{name}_max"].max()))

    def late_range(self, name: str) -> Range:
        """Return the range of a variable over the last 20 s of the run."""
        end = self["time_reached"]
        return self.range_of(name, end - STRETCH, end)

    def last_widths(self, name: str, length: float, count: int) -> list[float]:
        """Return widths of a variable's ranges over the last stretches, the last one first.

        Parameters
        ----------
        name : of the variable
        length : of a stretch, s
        count : number of stretches
        """
        ends = self["time_reached"] - length * np.arange(count)
        return [self.range_of(name, end - length, end).width for end in ends]

    @property
    def quarters(self) -> list[float]:
        """Widths of the disc's range over the last two quarters of the time after the first
        separation, the last one first."""
        quarter = (self["time_reached"] - self["first_separation"]) / 4
        return self.last_widths("w_point", quarter, 2)

    @property
    def quarter_growth(self) -> float:
        """Ratio of these widths: that of the last quarter over that of the third."""
        late, before = self.quarters
        return late / before

    @property
    def growth_in_the_end(self) -> float:
        """Ratio of the disc's range in the last 20 s over that in the 20 s before."""
        late, before = self.last_widths("w_point", STRETCH, 2)
        return late / before

    def slope(self, name: str, start: float, stop: float) -> float:
        """Return the mean growth rate of a variable's range between two times in s, in 1/s."""
        part = self.history.sel(time=slice(start, stop))
        if part.sizes["time"] < FEWEST_BINS:
            raise Missing(f"case {self.name} has no history from {start:g} to {stop:g} s")
        low = part[f"{name}_min"].values
        high = part[f"{name}_max"].values
        width = high - low
        if not width.min() > 0:
            raise Missing(
                f"case {self.name} has no vibration in {name} from {start:g} to {stop:g} s"
            )
        slope, _ = np.polyfit(part["time"].values, np.log(width), 1)
        return float(slope)

    def settling(self) -> Settling:
        """Return whether the ranges of contact force and disc have settled.

        They are followed over the run, and over its last stretches, in which alone a change that
        has just begun shows.
        """
        whole = self.history.isel(time=slice(None, -1))  # the last bin is cut
        begin = self["time_reached"] - STRETCHES * STRETCH
        over_the_run = _settling_of_ranges(whole)
        late = _settling_of_ranges(whole.sel(time=slice(begin, None)))
        changing = [each for each in late if each.answer is Settled.CHANGING]
        order = [*Settled]
        return min(changing or over_the_run, key=lambda each: order.index(each.answer))

    @property
    def settled(self) -> bool:
        return self.settling().answer is Settled.SETTLED

    # ---- Events

    @cached_property
    def events(self) -> xr.Dataset:
        return self._stored("events")

    @property
    def kept_span(self) -> Range:
        """Span of time in s for which the case stores its events: all of it, if it states none."""
        attrs = {"kept_from": 0.0, "kept_until": np.inf} | self.events.attrs
        stop = min(float(attrs["kept_until"]), self["time_reached"])
        return Range(float(attrs["kept_from"]), stop)

    def switches(self, kind: str) -> xr.Dataset:
        """Return the stored events of one kind."""
        code = variables.EVENT_KINDS.index(kind)
        return self.events.isel(event=self.events["kind"].values == code)

    def times_of(self, kind: str) -> Array:
        """Return the times of the stored events of one kind, s."""
        return np.asarray(self.switches(kind)["time"])

    def intervals(self, kind: str = "stick_to_slip") -> Array:
        """Return times between successive stored releases, or separations, s."""
        intervals = np.diff(self.times_of(kind))
        if intervals.size < FEWEST:
            what = f"{kind}s"
            if kind == "stick_to_slip":
                what = "stick-slip cycles"
            raise Missing(f"case {self.name} keeps fewer than {FEWEST} {what}")
        return intervals

    @property
    def release_interval(self) -> float:
        """Mean of the intervals between releases, s."""
        return float(self.intervals().mean())

    @property
    def release_spread(self) -> float:
        """Standard deviation of these intervals over their mean."""
        return float(self.intervals().std() / self.release_interval)

    @property
    def period_length(self) -> float:
        """Time after which the intervals between releases repeat, s; 0 if they do not."""
        return float(self.intervals()[: self.late_motion.period].sum())

    @property
    def kind(self) -> str:
        """Class of the in-plane motion, a word of `Outcome`."""
        return str(self.late_motion.kind)

    @property
    def upward(self) -> float:
        """Share of the separations at which the slider moves upward."""
        velocity = self.switches("separation")["u_velocity"].values
        if not velocity.size:
            raise Missing(f"case {self.name} keeps no separation")
        return float(np.mean(velocity > 0))

    @property
    def separated_part(self) -> float:
        """Length of the longest separation over the mean time from one to the next."""
        return self.longest_separation * self.rate_of("separation")

    def rate_of(self, kind: str) -> float:
        """Return the rate of one kind of event within the stored events, 1/s."""
        return self.times_of(kind).size / self.kept_span.width

    @cached_property
    def late_motion(self) -> Motion:
        """Class of the in-plane motion within the stored events."""
        return classify.motion_of(self.intervals())

    @property
    def stick(self) -> float:
        """Fraction of time in stick, within the stored events."""
        return self.phase_share("stick")

    @property
    def stick_in_all(self) -> float:
        """Fraction of time in stick, of the whole run."""
        return self["time_stick"] / self["time_reached"]

    @property
    def longest_separation(self) -> float:
        """Longest of the separations that begin within the stored events, s.

        One that lasts beyond them counts to their end.
        """
        begins = self.times_of("separation")
        ends = self.times_of("reattachment")
        next_end = np.searchsorted(ends, begins, side="right")
        whole = next_end < ends.size
        if not whole.any():
            raise Missing(f"case {self.name} keeps no whole separation")
        durations = ends[next_end[whole]] - begins[whole]
        longest = float(durations.max())
        if whole.all():
            return longest
        return max(longest, self.kept_span.high - float(begins[-1]))

    def phase_share(self, phase: str) -> float:
        """Return the fraction of time spent in a phase, within the stored events."""
        ends = np.append(self.events["time"].values, self.kept_span.high)
        durations = np.diff(ends)
        in_phase = self.events["phase"].values == variables.PHASES.index(phase)
        return ratio(
            float(durations[in_phase].sum()),
            float(durations.sum()),
            f"the time that events of case {self.name} cover",
        )

    # ---- Samples

    def samples(self, window: str) -> xr.Dataset:
        """Return the samples of a window, or of the section ``poincare``."""
        return self._stored(window)

    def places(self, last: float, share: float = PLACE) -> int:
        """Return at how many places the last points of the disc's section lie.

        Parameters
        ----------
        last : number of points
        share : of their range, by which different places differ along an axis
        """
        section = self.samples("poincare").isel(time=slice(-int(last), None))
        columns = [section[name].values for name in ("w_point", "w_point_velocity")]
        return signals.distinct_points(np.column_stack(columns), share)

    def signal(self, window: str, start: float, stop: float, name: str = "w_point") -> "Signal":
        """Return a variable between two times in s, from the samples of a window."""
        samples = self.samples(window).sel(time=slice(start, stop))
        if samples.sizes["time"] < FEWEST_SAMPLES:
            raise Missing(
                f"case {self.name} has no samples in {window} from {start:g} to {stop:g} s"
            )
        return Signal(self.name, window, samples["time"].values, samples[name].values)

    def _stored(self, name: str) -> xr.Dataset:
        """Return a window of the case, or its events; if it is missing, say of which case."""
        try:
            return dataset.group(self.node, name)
        except Missing as reason:
            raise Missing(f"case {self.name} {reason}") from None


def _settling_of_ranges(history: xr.Dataset) -> list[Settling]:
    """Return whether the ranges of contact force and disc have settled in a history."""
    found = []
    for name in ("P", "w_point"):
        width = history[f"{name}_max"] - history[f"{name}_min"]
        time = history["time"].values
        found.append(classify.settling(time, width.values, STEADY, still=1.0))
    return found


class Signal(NamedTuple):
    """Samples of a variable of a case between two times.

    Fractions of its spectrum are comparable for stretches of equal length only.
    """

    case: str
    window: str
    time: Array
    values: Array

    @property
    def filled(self) -> float:
        """Fraction of 20 to 300 Hz in which the amplitude exceeds 1e-4 of the strongest.

        Fuzz fills it, and lines do not.
        """
        return signals.coverage(self.time, self.values, LOW, 300.0, floor=1e-4)

    def power_above(self, frequency: float) -> float:
        """Return the ratio of the power above a frequency in Hz to that above `LOW`.

        Raises `Missing` if there is no line above `LOW`.
        """
        self.lines(above=LOW)
        return signals.power_share(self.time, self.values, frequency, LOW)

    def lines(self, count: int | None = None, **options: float) -> list[spectra.Line]:
        """Return lines of the spectrum; raises `Missing` if there are none.

        Parameters
        ----------
        count : number of lines to return, the strongest first; all by frequency if None
        options : of `disc_model.analysis.spectra.lines`
        """
        found = spectra.lines(self.time, self.values, **options)
        if not found:
            raise Missing(f"case {self.case} has no line in the spectrum of {self.window}")
        if count is None:
            return found
        return sorted(found, key=lambda line: -line.amplitude)[:count]

    def strongest(self, near: float, within: float) -> spectra.Line:
        """Return the strongest line within `within` Hz of a frequency; raises `Absent`."""
        try:
            return signals.strongest(self.time, self.values, near, within)
        except ValueError as error:
            raise Absent(f"case {self.case}: {error} in w_point") from None


Cases = Sequence[CaseView]


# ---- Several cases


def views(trees: Mapping[str, xr.DataTree]) -> dict[str, CaseView]:
    """Return views, by name, of cases and of grid studies.

    Cases are trees of their own, or merged in one that bears the name ``cases``.
    """
    nodes = dict(trees)
    merged = nodes.pop("cases", None)
    if merged is not None:
        nodes.update(merged.children)
    return {name: CaseView(name, node) for name, node in nodes.items()}


def pairs(cases: Cases) -> list[tuple[CaseView, CaseView]]:
    """Return cases with separation, each with the case that ignores separation.

    Raises `Missing` if one has no such case.
    """
    bilateral = {case.parameters: case for case in cases if case.bilateral}
    found = []
    alone = []
    for case in cases:
        if case.bilateral:
            continue
        other = bilateral.get(case.parameters.replace(contact="bilateral"))
        if other is None:
            alone.append(case.name)
        else:
            found.append((case, other))
    if alone:
        raise Missing(
            f"without separation there is no case with the parameters of {', '.join(alone)}"
        )
    return found


def ratio(part: float, whole: float, what: str) -> float:
    """Return the ratio of two numbers; raises `Missing` if the denominator is not positive.

    Parameters
    ----------
    part, whole : numerator and denominator
    what : what the denominator is, for the message
    """
    if not whole > 0:
        raise Missing(f"{what} is {whole:g}")
    return part / whole


def width_ratio(case: CaseView, bilateral: CaseView) -> float:
    """Return the late range of the disc with separation over that without."""
    what = f"the range of the disc in case {bilateral.name}"
    return ratio(case.disc.width, bilateral.disc.width, what)


# ---- Grid studies


def published(study: xr.Dataset) -> xr.Dataset:
    """Return the points of a grid study with the published modes."""
    return study.sel(normalization="as_published")


def sound(study: xr.Dataset) -> xr.Dataset:
    """Return the grid study; raises `Missing` if a point failed."""
    if "outcome" in study:
        failed = variables.flag_names(study["outcome"]) == "failed"
    else:
        failed = variables.flag_names(study["status"]) != "ok"
    if failed.any():
        raise Missing(f"study {study.attrs.get('study', '')} has points that failed")
    return study


def facts(study: xr.Dataset) -> Found:
    """Return what sentences state of a grid study.

    These are its base values, its options, and the extent of each axis of numbers.
    """
    found = {**variables.stated_in(study, "base"), **variables.stated_in(study, "options")}
    for name, axis in study.indexes.items():
        if axis.dtype.kind in "if":
            found[str(name)] = extent(axis)
    return found


# ---- Numbers in words


def extent(values: Iterable[float]) -> Range:
    """Return the range of numbers."""
    numbers = np.asarray([*values])
    return Range(float(numbers.min()), float(numbers.max()))


def repeats(motion: Motion, name: str) -> str:
    """Return after how many events of a name a motion repeats, or else its class, in words."""
    if motion.period:
        return f"repeats after {counted(motion.period, name)}"
    return f"is {motion}"


def place(N: float, Omega: float) -> str:
    """Return a preload in N and a speed in rad/s as text."""
    return f"{N:g} N, {Omega:g} rad/s"


def or_none(value: float, spec: str, unit: str = "", without: str = "none") -> str:
    """Return a number with its unit as text, or another text if the number is nan.

    Parameters
    ----------
    value : the number
    spec : its format
    unit : what follows the number
    without : the text for nan
    """
    if math.isnan(value):
        return without
    return f"{value:{spec}}{unit}"


def rate_text(rate: float, unit: str = "", without: str = "no cycle") -> str:
    """Return a growth rate as text, or another text if there is no cycle."""
    return or_none(rate, "+.4f", unit, without)
