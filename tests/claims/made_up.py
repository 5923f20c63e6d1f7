"""A study with the paper's cases whose motions are made up, not simulated: what claims are judged by, in every detail.

A `Story` says what a case did; `tell` writes it down as a simulation would, with the windows and events that
config/paper.yaml asks for.  `AS_TOLD` is what the paper says happened.
"""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.dataset import events_dataset, failed_groups, samples_dataset
from disc_model.data.variables import PHASES, STATUSES
from disc_model.parameters import Parameters
from disc_model.plate import slider_at_rest_frequencies
from disc_model.simulation.case import CaseSpec, Start, Window
from disc_model.studies.schema import load_study

PAPER = Path(__file__).parents[2] / "config" / "paper.yaml"
STICK, SLIP, SEPARATION = range(len(PHASES))
Signal = Callable[[CaseSpec, float, np.ndarray], np.ndarray]


def combinations(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """The drive and its multiples, and pairs of lines n f_s -/+ f_drive: what Table 2 lists."""
    drive = spec.parameters.Omega / (2 * np.pi)
    values = np.cos(2 * np.pi * drive * t) + 0.1 * np.cos(4 * np.pi * drive * t) + 0.05 * np.cos(6 * np.pi * drive * t)
    for n, size in zip(range(1, 5), (3e-2, 1e-2, 3e-3, 1e-3), strict=True):
        values += size * (np.cos(2 * np.pi * (n * rate - drive) * t) + np.sin(2 * np.pi * (n * rate + drive) * t))
    return values


def logistic(count: int) -> np.ndarray:
    """Chaos between -1 and 1."""
    x = np.full(count, 0.3)
    for j in range(1, count):
        x[j] = 4 * x[j - 1] * (1 - x[j - 1])
    return 2 * x - 1


def fuzz(t: np.ndarray, size: float) -> np.ndarray:
    """Noise below 400 Hz, the same at every call."""
    noise = np.fft.rfft(np.random.default_rng(len(t)).standard_normal(len(t)))
    noise[np.fft.rfftfreq(len(t), t[1] - t[0]) > 400] = 0.0
    return size * np.fft.irfft(noise, len(t))


def crowded(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """More lines than a motion in contact has."""
    return combinations(spec, rate, t) + sum(0.01 * np.cos(2 * np.pi * f * t) for f in range(30, 1000, 37))


def turns(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """N = 385 N, 15.1 rad/s: lines; fuzz until 100 s; high frequencies after the first separation."""
    late = np.where(t > 54.45, 0.03 * np.sin(2 * np.pi * 1000 * t), 0.0)
    return combinations(spec, rate, t) + late + np.where((t > 30) & (t < 90), fuzz(t, 0.02), 0.0)


def coupled(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """N = 300 N, 20 rad/s: the lowest mode with the slider attached, moved by the rotation; fuzz; high frequencies."""
    lowest, drive = slider_at_rest_frequencies(spec.parameters)[0] / (2 * np.pi), spec.parameters.Omega / (2 * np.pi)
    values = sum(np.cos(2 * np.pi * (lowest + side * drive) * t + side) for side in (-2, -1, 1, 2))
    return values + fuzz(t, 0.01) + np.where(t > 149.45, 0.3 * np.sin(2 * np.pi * 1000 * t), 0.0)


def natural(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """Lines at natural frequencies with the slider attached, moved by the rotation, whatever the stick-slip rate is."""
    drive = spec.parameters.Omega / (2 * np.pi)
    lowest = slider_at_rest_frequencies(spec.parameters)[[0, 1, 3]] / (2 * np.pi)
    return sum(np.cos(2 * np.pi * (f + side * 1.3 * drive) * t) for f in lowest for side in (-1, 1))


def few(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """The drive and the stick-slip rate."""
    return np.cos(spec.parameters.Omega * t) + 0.01 * np.cos(2 * np.pi * rate * t)


def erratic(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """E = 100 GPa: lines that have nothing to do with one another, none of them high."""
    return sum(np.cos(2 * np.pi * f * t) for f in (90.7, 131.9, 210.3, 333.1, 401.9))


def driven(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """As `coupled`, with as much power in the drive's own line as in the rest."""
    return coupled(spec, rate, t) + 2 * np.cos(spec.parameters.Omega * t)


def one_more(spec: CaseSpec, rate: float, t: np.ndarray) -> np.ndarray:
    """One further frequency, 126.1 Hz, with its sums and differences with the stick-slip rate and the drive's."""
    drive = spec.parameters.Omega / (2 * np.pi)
    return sum(np.cos(2 * np.pi * (126.1 + n * rate + m * drive) * t) for n in (-1, 0, 1) for m in (-1, 1))


@dataclass(frozen=True)
class Cycle:
    """What `disc_model.stability.cycle` would find."""

    growth_rate: float
    stick_fraction: float
    multipliers: tuple[complex, ...] = (0.5 + 0.9j,)
    kind: str = "neimark_sacker"


def cycle_as_told(p: Parameters) -> Cycle:
    """A stiffer disc and a damped one are more stable; the stick phase grows with the load."""
    return Cycle(0.2 * (150e9 / p.E - 0.9) - 1e3 * p.D_star, p.N / 1000)


def cycle_to_the_contrary(p: Parameters) -> Cycle:
    """The other way round."""
    told = cycle_as_told(p)
    return Cycle(-told.growth_rate, 1 - told.stick_fraction, (-1.1 + 0j,), "period_doubling")


@dataclass(frozen=True)
class Story:
    """What a case did.

    Attributes
    ----------
    first : s, the first loss of contact; nan for none
    early, late : range of the contact force over the preload, at first and in the end
    disc_early, disc_late : m, range of the disc's displacement
    grows_on : 1/s, rate at which that grows after the first separation
    sharp : 1/s, rate at which that grows in the last ten seconds before the first separation
    rate : Hz, stick releases
    wanders : how much the intervals between releases vary, quasi-periodically unless `chaotic`
    stick, stick_before : share of time in stick, in the end and in the whole run
    signal : what the disc's point does
    second : share of the slider's swing at the second frequency that `cycle_as_told` brings
    misprinted : slip ends where Eq. (24) as printed is false
    swing : rad, how far the slider's swing is past its highest point where contact is lost
    contrary : the disc moves downwards when contact is lost, separations last half a cycle and are no true ones, and
        the slider's orbit stays what it was
    """

    first: float = math.nan
    early: float = 0.02
    late: float = 0.02
    disc_early: float = 1e-3
    disc_late: float = 1e-3
    sharp: float = 0.0
    grows_on: float = 0.0
    rate: float = 67.63
    wanders: float = 0.0
    chaotic: bool = False
    stick: float = 0.3
    stick_before: float = 0.3
    signal: Signal = combinations
    second: float = 0.0
    misprinted: bool = False
    swing: float = 0.0
    contrary: bool = False

    @property
    def separates(self) -> bool:
        return math.isfinite(self.first)

    def replace(self, **changes: object) -> Story:
        return dataclasses.replace(self, **changes)

    # ---- the range of vibration against time
    def _grown(self, t: np.ndarray, end: float) -> np.ndarray:
        """0 at the start, 1 in the end; slowly to a third, then fast until contact is lost."""
        if not self.separates:
            return np.clip(4 * t / end, 0.0, 1.0)
        slow = np.clip(t / self.first, 0, 1) / 3
        return np.where(t < self.first, slow + 2 / 3 * np.exp(np.minimum(0.5 * (t - self.first), 0.0)), 1.0)

    def force_range(self, t: np.ndarray, end: float) -> np.ndarray:
        return self.early + (self.late - self.early) * self._grown(t, end)

    def disc_range(self, t: np.ndarray, end: float) -> np.ndarray:
        width = self.disc_early + (self.disc_late - self.disc_early) * self._grown(t, end)
        if self.grows_on:
            width = width * np.exp(self.grows_on * np.clip(t - self.first, 0, None))
        if not self.sharp:
            return width
        # slow growth, ten seconds of sharp growth, then less of it, and none after the loss of contact
        bent = np.interp(t, [0, self.first - 10, self.first - 3, self.first], [0, 0.1, 0.1 + 7 * self.sharp, 2.2])
        return self.disc_late * np.exp(bent - 2.2)

    # ---- stick and slip
    def releases(self, start: float, stop: float) -> np.ndarray:
        """Times of stick releases within a span, s."""
        count = int((stop - start) * self.rate)
        varied = logistic(count) if self.chaotic else np.sin(np.arange(count) * 2.399963)
        times = start + 1e-3 + np.cumsum(1 + self.wanders * varied) / self.rate
        return times[times < stop - 1 / self.rate]


def tell(spec: CaseSpec, story: Story) -> xr.DataTree:
    """The case as its file would hold it."""
    reached = min(spec.t_end, story.first if spec.stop_at and story.separates else math.inf)
    groups = {"/": _scalars(spec, story, reached)}
    for name, window in spec.windows:
        stop = min(window.stop, reached)
        if window.envelope:
            groups[f"/{name}"] = _history(spec, story, window, stop)
        else:
            t = window.start + np.arange(int((stop - window.start) * window.rate * (1 + 1e-12)) + 1) / window.rate
            groups[f"/{name}"] = samples_dataset(_samples(spec, story, t), window.theta)
    if spec.poincare is not None:
        turn = 2 * np.pi / spec.parameters.Omega
        t = np.arange(int(reached / turn)) * turn
        groups["/poincare"] = samples_dataset(_samples(spec, story, t), spec.poincare.theta)
    if spec.events is not None:
        groups["/events"] = _events(spec, story, *spec.events)
    return xr.DataTree.from_dict(groups)


def _scalars(spec: CaseSpec, story: Story, reached: float) -> xr.Dataset:
    p = spec.parameters
    empty = failed_groups(p, spec.t_end, spec.tol, "")[""]
    if spec.start != Start():
        empty.attrs["start"] = spec.start.model_dump_json()
    stuck = story.stick_before * reached
    values = {
        "status": STATUSES.index("stopped" if reached < spec.t_end else "ok"),
        "first_separation": story.first,
        "n_separations": int(story.separates),
        "time_reached": reached,
        "time_stick": stuck,
        "time_slip": reached - stuck,
        "u_0": -p.N * 1e-5,
    }
    return empty.assign({name: ((), value, empty[name].attrs) for name, value in values.items()})


def _history(spec: CaseSpec, story: Story, window: Window, stop: float) -> xr.Dataset:
    width = window.envelope / window.rate
    t = window.start + width * (np.arange(int((stop - window.start) / width + 1e-3)) + 0.5)
    force, disc = story.force_range(t, spec.t_end) * spec.parameters.N / 2, story.disc_range(t, spec.t_end) / 2
    middle = {"P": spec.parameters.N, "w_point": 0.0}
    half = {"P": force, "w_point": disc}
    bounds = {
        f"{name}_{end}": middle[name] + side * half[name] for name in half for end, side in (("min", -1), ("max", 1))
    }
    return samples_dataset({"time": t} | bounds, window.theta)


def _samples(spec: CaseSpec, story: Story, t: np.ndarray) -> dict[str, np.ndarray]:
    cycle = (t * story.rate) % 1.0
    phase = np.where(cycle > 1 - story.stick, STICK, SLIP)
    if story.separates:
        phase = np.where((t > story.first) & (cycle > 0.2) & (cycle < 0.25), SEPARATION, phase)
    signal = story.signal(spec, story.rate, t)
    # the slider's orbit: fuzzy while the disc is, another one after contact was lost
    lost = np.where(t > story.first, 1.0, 0.0) * (story.separates and not story.contrary)
    turn = cmath.phase(cycle_as_told(spec.parameters).multipliers[0]) / (2 * np.pi)
    psi = (0.05 + 0.05 * lost) * (
        np.cos(2 * np.pi * story.rate * t) + story.second * np.cos(2 * np.pi * (1 - turn) * story.rate * t)
    )
    if story.signal is turns:
        psi += np.where(t < story.first, fuzz(t, 1e-3), 0.0)
    height = -spec.parameters.N * 1e-5 + 1e-2 * np.cos(2 * np.pi * (cycle - 0.2) + story.swing)
    return {
        "time": t,
        "P": np.where(phase == SEPARATION, float(story.contrary), spec.parameters.N),
        "u": height,
        "w_point": 0.5 * story.disc_range(t, spec.t_end) * signal,
        "w_point_velocity": np.gradient(signal, t),
        "psi": psi,
        "psi_velocity": spec.parameters.Omega * np.where(phase == STICK, 1 - 0.01 * story.contrary, 0.3),
        "phase": phase,
    }


def _events(spec: CaseSpec, story: Story, start: float, stop: float) -> xr.Dataset:
    p, released = spec.parameters, story.releases(start, stop)
    if p.N == 3000:  # the one case whose first release is looked at
        released = released - released[0] + p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    rows, velocity = [], -0.4 if story.contrary else 0.4
    for j, t in enumerate(released if p.N < 1e4 else ()):
        after = [(0.0, "stick_to_slip", "slip"), ((1 - story.stick) / story.rate, "slip_to_stick", "stick")]
        if story.separates and t > story.first:
            end = 0.7 if story.contrary else 0.25
            apart = [(0.2 / story.rate, "separation", "separation"), (end / story.rate, "reattachment", "slip")]
            after = sorted([*(after if story.stick else ()), *apart])
        angle = 0.05 * (1 + story.wanders * math.sin(j))
        force = 0.0 if story.misprinted else p.r_0 * p.k_p * angle / p.mu_s + p.N
        rows += [(t + dt, kind, phase, angle, -p.N * 1e-5 + 1e-2, velocity, force) for dt, kind, phase in after]
    frame = pd.DataFrame(rows, columns=["time", "kind", "phase", "psi", "u", "u_velocity", "P"])
    return events_dataset(frame).assign_attrs(kept_from=start, kept_until=stop)


GROWING = Story(early=0.01, late=1.0, disc_late=5e-3)
WILD = GROWING.replace(wanders=0.7)
STILL = Story()
FIVE_POINTS = 21.4 / (2 * math.pi / 20)
"""Hz; a rate of releases at which a section at 20 rad/s has five points."""
BONDED = Story(disc_late=3e-2, signal=few, rate=FIVE_POINTS)


def _separating(stories: Mapping[str, float]) -> dict[str, Story]:
    return {name: GROWING.replace(first=first) for name, first in stories.items()}


def as_told() -> dict[str, Story]:
    """What happened, by the paper."""
    return {
        **dict.fromkeys(load_study(PAPER).specs, STILL),
        "F02": WILD.replace(first=480.0, signal=crowded, misprinted=True),
        "F04": BONDED.replace(misprinted=True),
        "F13bonded": BONDED,
        "F17bonded": BONDED,
        "F06": BONDED,
        "F07": WILD.replace(first=149.45, sharp=0.25, signal=coupled, rate=71.1),
        "F08": BONDED,
        "F09": GROWING.replace(first=117.0, stick=0.0, stick_before=0.1),
        "F13": GROWING.replace(first=54.45, signal=turns),
        "S43N0": Story(stick_before=0.0),
        "S43Ninf": Story(stick=1.0, stick_before=1.0),
        "F21": Story(late=0.3, wanders=0.01, chaotic=True, signal=erratic),
        "F17": WILD.replace(first=810.0),
        "F22": GROWING.replace(first=220.0, wanders=0.1, chaotic=True, second=0.01),
        "F23": GROWING.replace(first=240.0, swing=math.pi),
        **_separating({"F18": 263, "F19": 51, "C4cp1": 40, "S43kp2e4": 100, "S43k2e4": 100, "S43k3e4": 200}),
        **_separating({"P03l5": 54.4, "P03l6": 54.4, "P03l8": 54.5, "P03l8c2": 54.5}),
        **_separating(dict.fromkeys(("S43z4", "S43z4a", "S43z4b", "S43z4c"), 800)),
        **{name: GROWING.replace(first=0.01, stick=0.0) for name in ("F02free", "F07free", "F17free")},
        **_separating({"S43c126": 700, "S43c14": 700, "S43c145": 700, "S43c124": 1000}),
    }


def to_the_contrary() -> dict[str, Story]:
    """The opposite in all that is claimed."""
    alone = Story(late=0.02, disc_early=5e-2, disc_late=5e-2, contrary=True, rate=FIVE_POINTS)
    return {
        **dict.fromkeys(load_study(PAPER).specs, GROWING),
        "F02": alone.replace(first=480.0),
        "F04": WILD.replace(stick=0.005, rate=FIVE_POINTS),
        "F06": WILD.replace(stick=0.005, rate=FIVE_POINTS),
        "F07": alone.replace(first=147.0),
        "F08": WILD.replace(stick=0.005),
        "F09": alone.replace(first=117.0),
        "F11": WILD.replace(first=100.0),
        "F13": WILD.replace(first=55.0, signal=erratic, disc_early=5e-3, second=0.1),
        "F17": GROWING,
        "F19": WILD.replace(first=51.0),
        "F20": WILD,
        "F21": Story(first=500.0, signal=turns),
        "F22": Story(first=50.0),
        "F23": GROWING.replace(first=240.0),
        "S43N0": GROWING.replace(first=20.0, stick_before=0.5),
        "S43Ninf": Story(),
        "T2kp18": STILL.replace(signal=erratic),
        "T2kp22": STILL.replace(signal=erratic),
        "T2Om12": STILL.replace(signal=erratic),
        **_separating({"S43k2e4": 200, "S43k3e4": 100, "S43k2e5": 100, "S43kp2e5": 100, "C4cpN50": 100}),
        **_separating({"P03l5": 50, "P03l6": 54.4, "P03l8": 54.5, "P03l8c2": 54.5, "S43c12": 500, "S43c126": 1000}),
    }


def made_up(stories: Mapping[str, Story]) -> xr.DataTree:
    """The study's merged cases, as far as claims look at them."""
    specs = load_study(PAPER).specs
    return xr.DataTree.from_dict({f"/{name}": tell(specs[name], story) for name, story in stories.items()})


def scans(least: float = 0.2, settled: bool = True, softest: str = "growing") -> dict[str, xr.Dataset]:
    """Grid studies: stick without separation, and what becomes of the published start on softer and stiffer discs.

    least, settled : share of stick where it is least, and whether the motion there has settled
    softest : outcome on the softest disc
    """
    shares, times = np.full((3, 2), 0.25), np.full((3, 2), 100.0)
    shares[0, 1], times[0, 1] = least, 100.0 if settled else np.nan
    bonded = {"share_stick": (("Omega", "N"), shares), "settled": (("Omega", "N"), times)}
    kinds = ["failed", "quiet", "growing", "separation"]
    outcome = np.full((3, 2, 2), kinds.index("quiet"), dtype=np.int8)
    outcome[0, 1], outcome[2] = kinds.index(softest), kinds.index("separation")
    flags = {"flag_values": np.arange(len(kinds), dtype=np.int8), "flag_meanings": " ".join(kinds)}
    return {
        "bonded": xr.Dataset(bonded, {"Omega": [10, 50, 100], "N": [50, 385]}),
        "map_E": xr.Dataset(
            {"outcome": (("E", "Omega", "normalization"), outcome, flags)},
            {"E": [8e10, 1e11, 1.5e11], "Omega": [10, 50], "normalization": ["as_published", "orthonormal"]},
            {"base": '{"N": 200}'},
        ),
    }


def orthonormal(tree: xr.DataTree) -> xr.DataTree:
    """The same motions, said to be of modes normalised as Eq. (17) says; and a case that the paper has not."""
    found = tree.copy()
    for case in found.children.values():
        p = Parameters.model_validate_json(case.attrs["parameters"]).replace(normalization="orthonormal")
        case.attrs = case.attrs | {"parameters": p.canonical_json}
    return found.assign({"X30": found["F02"]})
