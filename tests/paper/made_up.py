"""A study with the paper's cases whose motions are made up, not simulated.

A `Story` says what a case did; `tell` writes it down as a simulation would, with the windows and events that
config/paper.yaml asks for.  `AS_TOLD` is what the paper says happened, `TO_THE_CONTRARY` the opposite of all of it.
"""

import cmath
import dataclasses
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Self

import numpy as np
import pandas as pd
import xarray as xr
import yaml

from disc_model.data.dataset import events_dataset, samples_dataset, scalars_dataset
from disc_model.data.variables import PHASES, STATUSES
from disc_model.disc.plate import coupled_natural_frequencies
from disc_model.paper.measures import CaseView
from disc_model.paper.section41 import Powers
from disc_model.parameters import Parameters
from disc_model.simulation.case import CaseSpec, Start
from disc_model.studies.study import load_study
from tests.damages import Damage

SPECS = load_study(Path(__file__).parents[2] / "config" / "paper.yaml").specs
STICK, SLIP, SEPARATION = range(len(PHASES))
Signal = Callable[[Parameters, float, np.ndarray], np.ndarray]
"""What the disc's point does, by the case, the stick-slip rate in Hz, and times in s."""


def waves(t: np.ndarray, *lines: tuple[float, float]) -> np.ndarray:
    """A sum of cosines, each of a frequency in Hz and an amplitude."""
    return sum(size * np.cos(2 * np.pi * f * t) for f, size in lines)


def drive(p: Parameters) -> float:
    return p.Omega / (2 * np.pi)


def combinations(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """The drive and its multiples, and pairs of lines n f_s -/+ f_drive: what Table 2 lists."""
    pairs = [(n * rate + side * drive(p), 3 * 10 ** (-0.5 * n - 1.5)) for n in range(1, 5) for side in (-1, 1)]
    return waves(t, (drive(p), 1.0), (2 * drive(p), 0.1), (3 * drive(p), 0.05), *pairs)


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


def crowded(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """More lines than a motion in contact has."""
    return combinations(p, rate, t) + waves(t, *((f, 0.01) for f in range(30, 1000, 37)))


def turns(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """N = 385 N, 15.1 rad/s: lines; fuzz until 100 s; high frequencies after the first separation."""
    late = np.where(t > 54.45, waves(t, (1000, 0.03)), 0.0)
    return combinations(p, rate, t) + late + np.where((t > 30) & (t < 90), fuzz(t, 0.02), 0.0)


def coupled(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """N = 300 N, 20 rad/s: the lowest mode with the slider attached, moved by the rotation; fuzz; high frequencies."""
    lowest = coupled_natural_frequencies(p)[0] / (2 * np.pi)
    values = waves(t, *((lowest + side * drive(p), 1.0) for side in (-2, -1, 1, 2)))
    return values + fuzz(t, 0.01) + np.where(t > 149.45, waves(t, (1000, 0.3)), 0.0)


def natural(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """Lines at natural frequencies with the slider attached, moved by the rotation, whatever the stick-slip rate is."""
    lowest = coupled_natural_frequencies(p)[[0, 1, 3]] / (2 * np.pi)
    return waves(t, *((f + side * 1.3 * drive(p), 1.0) for f in lowest for side in (-1, 1)))


def few(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """The drive and the stick-slip rate."""
    return waves(t, (drive(p), 1.0), (rate, 0.01))


def loud(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """As `few`, ten thousand times as strong."""
    return 1e4 * few(p, rate, t)


def erratic(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """E = 100 GPa: lines that have nothing to do with one another, none of them high, and weak ones that move."""
    weak = (np.cos(2 * np.pi * (f * t + 0.05 * (t - 470) ** 2)) for f in (151, 177, 189, 231, 243))
    return waves(t, *((f, 1.0) for f in (90.7, 131.9, 210.3, 333.1, 401.9))) + 0.03 * sum(weak)


def clears(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """Fuzz until contact is lost at 300 N, 20 rad/s."""
    return combinations(p, rate, t) + np.where(t < 149.45, fuzz(t, 0.02), 0.0)


def sweeping(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """A line that moves by 1 Hz in 5 s."""
    return np.cos(2 * np.pi * (120 * t + 0.1 * t**2))


def cycle_as_told(p: Parameters) -> Any:
    """What a search for the cycle finds: a stiffer disc and a damped one are more stable, and stick grows with load."""
    rate = 0.2 * (150e9 / p.E - 0.9) - 1e3 * p.D_star - 0.1 * p.c - 1e-7 * p.k - (p.N > 1000)
    rate += 1e-3 * math.sin(math.pi * p.k_p / 5e4) - (p.k_p > 1e5)
    return SimpleNamespace(growth_rate=rate, stick_fraction=p.N / 1000, multipliers=(0.5 + 0.9j,))


def cycle_to_the_contrary(p: Parameters) -> Any:
    """The other way round."""
    told = cycle_as_told(p)
    return SimpleNamespace(
        growth_rate=-told.growth_rate, stick_fraction=1 - told.stick_fraction, multipliers=(-1.1 + 0j,)
    )


def _course(p: Parameters, supplied: float) -> tuple[Powers, ...]:
    """Powers in W by the square of the width in mm: maintained contact supplies twice what damping takes."""
    if p.contact == "bilateral":
        return tuple(Powers(1e-3 * x, 2.0 * x**2, 0.0, x**2, x**2) for x in range(1, 9))
    return (Powers(3.5e-3, 12.25 * supplied, 0.0, 12.25, 0.0),) * 4


def course_as_told(p: Parameters, until: float) -> tuple[Powers, ...]:
    """Separation withholds the surplus."""
    return _course(p, 1.0)


def course_to_the_contrary(p: Parameters, until: float) -> tuple[Powers, ...]:
    """Impacts take the surplus."""
    return _course(p, 2.0)


def windows_as_told(case: CaseView, prefix: str) -> Powers:
    """Of motions that are no motions of a disc."""
    return Powers(1e-3, 4.0, -3.0, 1.0, 0.0)


@dataclasses.dataclass(frozen=True)
class Story:
    """What a case did."""

    first: float = math.nan  # s, the first loss of contact; nan for none
    early: float = 0.02  # range of the contact force over the preload, at first
    late: float = 0.02  # and in the end
    disc_early: float = 1e-3  # m, range of the disc's displacement at first
    disc_late: float = 1e-3  # and in the end
    sharp: float = 0.0  # 1/s, rate at which that grows in the last ten seconds before the first separation
    grows_on: float = 0.0  # 1/s, rate at which that grows after the first separation
    rate: float = 67.63  # Hz, stick releases
    wanders: float = 0.0  # how much the intervals between releases vary, quasi-periodically
    chaotic: bool = False  # or chaotically
    stick: float = 0.3  # share of time in stick in the end
    stick_before: float = 0.3  # and in the whole run
    signal: Signal = combinations  # what the disc's point does
    second: float = 0.0  # share of the slider's swing at the second frequency that `cycle_as_told` brings
    misprinted: bool = False  # slip ends where Eq. (24) as printed is false
    repels: float = 0.0  # m, deviation of the height at the first release, which doubles every hundred releases
    swing: float = 0.0  # rad, how far the slider's swing is past its highest point where contact is lost
    # the disc moves downwards when contact is lost, separations last half a cycle and are no true ones, and the orbit
    # of the slider stays what it was
    contrary: bool = False

    @property
    def separates(self) -> bool:
        return math.isfinite(self.first)

    def but(self, **changes: object) -> Self:
        return dataclasses.replace(self, **changes)

    def grown(self, t: np.ndarray, end: float) -> np.ndarray:
        """0 at the start, 1 in the end; slowly to a third, then fast until contact is lost."""
        if not self.separates:
            return np.clip(4 * t / end, 0.0, 1.0)
        slow = np.clip(t / self.first, 0, 1) / 3
        return np.where(t < self.first, slow + 2 / 3 * np.exp(np.minimum(0.5 * (t - self.first), 0.0)), 1.0)

    def disc_range(self, t: np.ndarray, end: float) -> np.ndarray:
        if self.sharp:  # slow growth, ten seconds of sharp growth, then less of it, and none after the loss of contact
            bent = np.interp(t, [0, self.first - 10, self.first - 3, self.first], [0, 0.1, 0.1 + 7 * self.sharp, 2.2])
            return self.disc_late * np.exp(bent - 2.2)
        width = self.disc_early + (self.disc_late - self.disc_early) * self.grown(t, end)
        return width * np.exp(self.grows_on * np.clip(t - self.first, 0, None)) if self.grows_on else width

    def releases(self, start: float, stop: float) -> np.ndarray:
        """Times of stick releases within a span, s."""
        count = int((stop - start) * self.rate)
        varied = logistic(count) if self.chaotic else np.sin(np.arange(count) * 2.399963)
        times = start + 1e-3 + np.cumsum(1 + self.wanders * varied) / self.rate
        return times[times < stop - 1 / self.rate]


def tell(spec: CaseSpec, story: Story) -> xr.DataTree:
    """The case as its file would hold it."""
    p, end = spec.parameters, spec.t_end
    reached = min(end, story.first if spec.stop_at and story.separates else math.inf)
    root = scalars_dataset(p, {"t_end": end, "tol": spec.tol}, "failed", "")
    if spec.start != Start():
        root.attrs["start"] = spec.start.model_dump_json()
    values = {
        "status": STATUSES.index("stopped" if reached < end else "ok"), "first_separation": story.first,
        "n_separations": 50 * story.separates, "time_reached": reached, "time_stick": story.stick_before * reached,
        "time_slip": (1 - story.stick_before) * reached, "u_0": -p.N * 1e-5,
    }  # fmt: skip
    groups = {"/": root.assign({name: ((), value, root[name].attrs) for name, value in values.items()})}
    for name, window in spec.windows:
        stop = min(window.stop, reached)
        if window.envelope:
            width = window.envelope / window.rate
            t = window.start + width * (np.arange(int((stop - window.start) / width + 1e-3)) + 0.5)
            force = (story.early + (story.late - story.early) * story.grown(t, end)) * p.N / 2
            disc = story.disc_range(t, end) / 2
            bounds = {"P_min": p.N - force, "P_max": p.N + force, "w_point_min": -disc, "w_point_max": disc}
            groups[f"/{name}"] = samples_dataset({"time": t} | bounds, window.theta)
        else:
            t = window.start + np.arange(int((stop - window.start) * window.rate * (1 + 1e-12)) + 1) / window.rate
            groups[f"/{name}"] = samples_dataset(_samples(spec, story, t), window.theta)
    if spec.poincare is not None:
        turn = 2 * np.pi / p.Omega
        groups["/poincare"] = samples_dataset(
            _samples(spec, story, np.arange(int(reached / turn)) * turn), spec.poincare.theta
        )
    if spec.events is not None:
        groups["/events"] = _events(p, story, *spec.events)
    return xr.DataTree.from_dict(groups)


def _samples(spec: CaseSpec, story: Story, t: np.ndarray) -> dict[str, np.ndarray]:
    p, cycle = spec.parameters, (t * story.rate) % 1.0
    phase = np.where(cycle > 1 - story.stick, STICK, SLIP)
    if story.separates:
        phase = np.where((t > story.first) & (cycle > 0.2) & (cycle < 0.25), SEPARATION, phase)
    signal = story.signal(p, story.rate, t)
    # the slider's orbit: fuzzy while the disc is, another one after contact was lost
    lost = np.where(t > story.first, 1.0, 0.0) * (story.separates and not story.contrary)
    turn = cmath.phase(cycle_as_told(p).multipliers[0]) / (2 * np.pi)
    psi = (0.05 + 0.05 * lost) * waves(t, (story.rate, 1.0), ((1 - turn) * story.rate, story.second))
    if story.signal is turns:
        psi += np.where(t < story.first, fuzz(t, 1e-3), 0.0)
    force = np.where(phase == SEPARATION, float(story.contrary), p.N)
    if p.contact == "bilateral":
        force = p.N * np.cos(2 * np.pi * cycle)
    return {
        "time": t,
        "P": force,
        "u_velocity": np.gradient(signal, t) + (-1 if story.contrary else 1) * force / p.N,
        "u": -p.N * 1e-5 + 1e-2 * np.cos(2 * np.pi * (cycle - 0.2) + story.swing),
        "w_point": 0.5 * story.disc_range(t, spec.t_end) * signal,
        "w_point_velocity": np.gradient(signal, t),
        "psi": psi,
        "psi_velocity": p.Omega * np.where(phase == STICK, 1 - 0.01 * story.contrary, 0.3),
        "phase": phase,
    }


def _events(p: Parameters, story: Story, start: float, stop: float) -> xr.Dataset:
    released = story.releases(start, stop)
    if p.N == 3000:  # the one case whose first release is looked at
        released = released - released[0] + p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    rows, velocity, lasts = [], (-0.4 if story.contrary else 0.4), (0.7 if story.contrary else 0.25)
    for j, t in enumerate(released if p.N < 1e4 else ()):
        after = [(0.0, "stick_to_slip", "slip"), ((1 - story.stick) / story.rate, "slip_to_stick", "stick")]
        if story.separates and t > story.first:
            apart = [(0.2 / story.rate, "separation", "separation"), (lasts / story.rate, "reattachment", "slip")]
            after = sorted([*(after if story.stick else ()), *apart])
        angle = 0.05 * (1 + story.wanders * math.sin(j))
        force = 0.0 if story.misprinted else p.r_0 * p.k_p * angle / p.mu_s + p.N
        height = -p.N * 1e-5 + 1e-2 + story.repels * 2 ** (j / 100)
        rows += [(t + dt, kind, phase, angle, height, velocity, force) for dt, kind, phase in after]
    if story.contrary:
        rows = rows[: max((i for i, row in enumerate(rows) if row[1] == "reattachment"), default=len(rows))]
    return kept_events(rows, start, stop, "psi", "u", "u_velocity", "P")


def kept_events(rows: Iterable[tuple[Any, ...]], start: float, stop: float, *beside: str) -> xr.Dataset:
    """Events as a case keeps them between two times: each a time, a kind, a phase and values beside."""
    frame = pd.DataFrame(rows, columns=["time", "kind", "phase", *beside])
    return events_dataset(frame).assign_attrs(kept_from=start, kept_until=stop)


GROWING = Story(early=0.01, late=1.0, disc_late=5e-3)
WILD = GROWING.but(wanders=0.7)
STILL = Story()
FIVE_POINTS = 21.4 / (2 * math.pi / 20)
"""Hz; a rate of releases at which a section at 20 rad/s has five points."""
BONDED = Story(disc_late=3e-2, signal=few, rate=FIVE_POINTS)
FREE = GROWING.but(first=0.01, stick=0.0)


NOTHING = Story(disc_early=5e-2, disc_late=5e-2, contrary=True, rate=FIVE_POINTS)
KINDS = {"still": STILL, "growing": GROWING, "wild": WILD, "bonded": BONDED, "free": FREE, "alone": NOTHING}
TEXTS = yaml.safe_load(Path(__file__).with_name("stories.yaml").read_text(encoding="utf-8"))


def story(said: Any, told: Story = STILL) -> Story:
    """As stories.yaml says it: the name of a kind, or a kind with other values; ``told`` is the case's own."""
    kinds = KINDS | {"told": told}
    if isinstance(said, str):
        return kinds[said]
    changes = {name: globals()[value] if name == "signal" else value for name, value in said.items()}
    return kinds[changes.pop("like", "still")].but(**changes)


def stories(texts: Mapping[str, Any], told: Mapping[str, Story]) -> dict[str, Story]:
    """Of cases, as stories.yaml says them; ``told`` is what they do by the paper."""
    return {name: story(said, told.get(name, STILL)) for names, said in texts.items() for name in names.split()}


AS_TOLD = dict.fromkeys(SPECS, STILL) | stories(TEXTS["by the paper"], {})
"""What happened, by the paper."""
TO_THE_CONTRARY = dict.fromkeys(SPECS, GROWING) | stories(TEXTS["to the contrary"], {})
"""The opposite in all that is claimed."""


@cache
def case(name: str, story: Story) -> xr.DataTree:
    """A case of the paper, told once; most tests change few of them."""
    return tell(SPECS[name], story)


def made_up(stories: Mapping[str, Story]) -> xr.DataTree:
    """The study's merged cases, as far as rows look at them."""
    return xr.DataTree.from_dict({f"/{name}": case(name, story) for name, story in stories.items()})


def cases(stories: Mapping[str, Story], scans: Mapping[str, xr.Dataset] | None = None) -> dict[str, CaseView]:
    """Cases and grid studies for checks."""
    nodes = {name: case(name, story) for name, story in stories.items()}
    nodes |= {name: xr.DataTree(scan) for name, scan in (scans or {}).items()}
    return {name: CaseView(name, node) for name, node in nodes.items()}


WORDS = ("ok", "failed", "quiet", "growing", "separation", "no_cycle", "no_stick_slip")
WORDS += ("none", "begins", "ends", "neutral", "fold", "no", "yes", "settled", "changing")


def grid(axes: Mapping[str, Any], stated: Mapping[str, Any] | None = None, **variables: Any) -> xr.Dataset:
    """A grid study: each variable along the first axes, as many as it has dimensions, its words as flags.

    stated : what it states, as its base and as its options alike
    """
    found = xr.Dataset(coords=axes, attrs=dict.fromkeys(("base", "options"), json.dumps(stated or {})))
    for name, given in variables.items():
        values, attrs = np.asarray(given), {}
        if values.dtype.kind == "U":
            values, attrs = np.vectorize(WORDS.index)(values), {"flag_meanings": " ".join(WORDS)}
        found[name] = (list(axes)[: values.ndim], values, attrs)
    return found


def scans(windows: Sequence[Sequence[float]] = TEXTS["windows"], **changes: Mapping[str, Any]) -> dict[str, xr.Dataset]:
    """Grid studies as stories.yaml has them, by name, some of them with other values.

    windows : rad/s, where separation begins and ends, at three preloads or more
    """
    texts = TEXTS["scans"]
    found = {name: grid(**texts.get(name, {}) | changes.get(name, {})) for name in texts | changes}
    found = {name: study.assign_attrs(study=name) for name, study in found.items()}
    speeds, preloads = np.array(windows)[:, None], [50.0, 200.0, 385.0, 500.0, 510.0]
    axes = {"normalization": ["as_published"], "N": preloads[: len(windows)], "horizon": [1000.0]}
    found["critical_speed"] = grid(
        axes | {"crossing_number": [0, 1], "scan_Omega": [5.0, 24.0]},
        status=[["ok"] * len(windows)],
        critical_speed=[speeds[..., 0]],
        crossing=[speeds],
        crossing_kind=[np.where(np.isnan(speeds), "none", ["begins", "ends"])],
    )
    return found


def root_with(**values: float) -> Damage:
    """Other values of what a case says of its whole run."""
    return lambda groups: groups | {"": groups[""].assign(values)}


def orthonormal(tree: xr.DataTree) -> xr.DataTree:
    """The same motions, said to be of modes normalised as Eq. (17) says; and a case that the paper has not."""
    found = tree.copy()
    for case in found.children.values():
        p = Parameters.model_validate_json(case.attrs["parameters"]).replace(normalization="orthonormal")
        case.attrs = case.attrs | {"parameters": p.canonical_json}
    return found.assign({"X30": found["F02"]})
