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
import pytest
import xarray as xr
import yaml

from disc_model.data.dataset import events_dataset, samples_dataset, scalars_dataset
from disc_model.data.variables import PHASES, STATUSES
from disc_model.paper.energy import Powers
from disc_model.paper.ledger import views
from disc_model.paper.measures import CaseView
from disc_model.parameters import Parameters
from disc_model.plate import coupled_natural_frequencies
from disc_model.simulation.case import CaseSpec, Start
from disc_model.studies.study import load_study

SPECS = load_study(Path(__file__).parents[2] / "config" / "paper.yaml").specs
STICK, SLIP, SEPARATION = range(len(PHASES))
Groups = dict[str, xr.Dataset]
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


def driven(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """As `coupled`, with as much power in the drive's own line as in the rest."""
    return coupled(p, rate, t) + waves(t, (drive(p), 2.0))


def one_more(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """One further frequency, 126.1 Hz, with its sums and differences with the stick-slip rate and the drive's."""
    return waves(t, *((126.1 + n * rate + m * drive(p), 1.0) for n in (-1, 0, 1) for m in (-1, 1)))


def split(p: Parameters, rate: float, t: np.ndarray) -> np.ndarray:
    """One further frequency, and a line 0.15 Hz beside one of its sums with the drive's."""
    return waves(t, (rate, 0.3), (126.1, 1.0), (126.1 + drive(p) + 0.15, 0.5))


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
    if p.contact == "bonded":
        return tuple(Powers(1e-3 * x, 2.0 * x**2, 0.0, x**2, x**2) for x in range(1, 9))
    return (Powers(3.5e-3, 12.25 * supplied, 0.0, 12.25, 0.0),) * 4


def course_as_told(p: Parameters, until: float) -> tuple[Powers, ...]:
    """Separation withholds the surplus."""
    return _course(p, 1.0)


def course_to_the_contrary(p: Parameters, until: float) -> tuple[Powers, ...]:
    """Impacts take the surplus."""
    return _course(p, 2.0)


@dataclasses.dataclass(frozen=True)
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
    repels : m, deviation of the height at the first release, which doubles every hundred releases
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
    repels: float = 0.0
    swing: float = 0.0
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
    if p.contact == "bonded":
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
    """The study's merged cases, as far as claims look at them."""
    return xr.DataTree.from_dict({f"/{name}": case(name, story) for name, story in stories.items()})


def cases(stories: Mapping[str, Story], scans: Mapping[str, xr.Dataset] | None = None) -> dict[str, CaseView]:
    """Cases and grid studies for checks."""
    return views(xr.DataTree(), scans) | {name: CaseView(name, case(name, story)) for name, story in stories.items()}


WORDS = ("ok", "failed", "quiet", "growing", "separation", "no_cycle", "no_stick_slip")
WORDS += ("none", "begins", "ends", "neutral", "fold", "no", "yes", "settled", "changing")


def grid(axes: Mapping[str, Any], stated: Mapping[str, Any] | None = None, /, **variables: Any) -> xr.Dataset:
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


def scans(
    least: float = 0.2,
    settled: bool = True,
    discs: Sequence[str] = ("growing", "quiet", "separation"),
    windows: Sequence[tuple[float, float]] = ((20, np.nan), (10, np.nan), (15, np.nan)),
    damped: str = "separation",
    strong: str = "",
    reach: int = 5,
    soft: Sequence[str] = ("separation",) * 3,
    faster: float = 0.3,
    others: float = 0.9,
    lasts: Sequence[float] = (),
) -> dict[str, xr.Dataset]:
    """Grid studies: stick without separation, and what becomes of the static start on softer and stiffer discs.

    least, settled : share of stick where it is least, and whether the motion there has settled
    discs : outcome on the softest, a softer and the usual one
    windows : rad/s, where separation begins and ends, at three preloads or more
    damped, strong : outcome at large preloads with in-plane damping, and with more of it; growth falls if they separate
    reach : number of preloads, from the least on, at which damping acts
    soft : outcome with the softest spring at 10, 11.25 and 20 rad/s
    faster : share of stick beyond 15.25 rad/s
    others : share of random starts that separate at 385 N, 15 rad/s, where the static one does not
    lasts : rad/s, where separation ends in sweeps down, at three preloads; no sweeps if there are none
    """
    published, preloads = {"normalization": ["as_published"]}, [50.0, 200.0, 385.0, 500.0, 510.0]
    shares, answers = np.full((3, 2), 0.25), np.full((3, 2), "settled", dtype="<U9")
    shares[0, 1], answers[0, 1] = least, "settled" if settled else "changing"
    bonded = {"stick_fraction": shares, "settled": answers}
    speeds = np.array(windows)[:, None]
    kinds = np.where(np.isnan(speeds), "none", ["begins", "ends"])
    crossings = {"critical_speed": [speeds[..., 0]], "crossing": [speeds], "crossing_kind": [kinds]}
    along = published | {"N": preloads[: len(windows)], "horizon": [1000.0], "crossing_number": [0, 1]}
    on_discs = [np.stack([("quiet",) * 3, discs], axis=1), np.full((3, 2), "quiet")]
    springs = [(kind, "separation", "quiet") for kind in soft]
    dampers = [0, 0.5, *([0.75] if strong else [])]
    pulled = np.full((5, len(dampers)), "quiet", dtype="<U12")
    pulled[2:reach, 1], pulled[1, 0], pulled[2:reach, 2:] = damped, damped, strong or damped
    falls = np.linspace(0.02, 0.01 if damped == "separation" else 0.03, len(dampers))
    random = published | {"Omega": [10.0, 15.0], "energy": [0.01, 3.0], "start": range(10)}
    found = {
        "basins": grid(
            random, {"N": 385}, separating_fraction=[[0.0, others]], separating_fraction_low=[[0.0, others / 2]]
        ),
        "bifurcation_Omega": grid({"Omega": [15.0, 15.25, 15.5, 16.0]}, stick_fraction=[0.31, 0.3, faster, faster]),
        "bonded": grid({"Omega": [10, 50, 100], "N": [50, 385]}, {"max_transient": 6400}, **bonded),
        "critical_speed": grid(along | {"scan_Omega": [5.0, 24.0]}, status=[["ok"] * len(windows)], **crossings),
        "map_E": grid(
            {"normalization": ["as_published", "orthonormal"], "E": [8e10, 1e11, 1.5e11], "Omega": [10, 50]},
            {"N": 200, "horizon": 1000},
            outcome=on_discs,
        ),
        "map_c_p": grid(
            published | {"N": [50.0, 200.0, 385.0, 500.0, 600.0], "c_p": dampers},
            {"Omega": 15, "horizon": 1000},
            outcome=[pulled],
            growth_rate=[np.tile(falls, (5, 1))],
        ),
        "map_k": grid(
            published | {"Omega": [10.0, 11.25, 20.0], "k": [1e4, 2e4, 1e5]},
            {"N": 200, "horizon": 1000},
            outcome=[springs],
        ),
    }
    if lasts:
        found["hysteresis"] = grid(published | {"N": preloads[:3]}, {"dwell": 60}, offset_speed=[lasts])
    return found


def orthonormal(tree: xr.DataTree) -> xr.DataTree:
    """The same motions, said to be of modes normalised as Eq. (17) says; and a case that the paper has not."""
    found = tree.copy()
    for case in found.children.values():
        p = Parameters.model_validate_json(case.attrs["parameters"]).replace(normalization="orthonormal")
        case.attrs = case.attrs | {"parameters": p.canonical_json}
    return found.assign({"X30": found["F02"]})


# ----------------------------------------------------------------------------------------------------
# Cases that hold less than the study of the paper asks for: what the schema lets through, or a failure


def damaged(case: xr.DataTree, damage: Callable[[Groups], Groups]) -> xr.DataTree:
    """A copy of a case, changed."""
    groups = {"": case.to_dataset()} | {str(n): node.to_dataset(inherit=False) for n, node in case.children.items()}
    return xr.DataTree.from_dict({f"/{name}": found for name, found in damage(groups).items()})


def root_with(**values: float) -> Callable[[Groups], Groups]:
    """Other values of what a case says of its whole run."""
    return lambda groups: groups | {"": groups[""].assign(values)}


def _failed(groups: Groups) -> Groups:
    p = Parameters.model_validate_json(groups[""].attrs["parameters"])
    return {"": scalars_dataset(p, {"t_end": 100.0, "tol": 1e-10}, "failed", "NonFinite: overflow")}


def _events_cut(count: int) -> Callable[[Groups], Groups]:
    def cut(groups: Groups) -> Groups:
        if "events" not in groups:
            return groups
        events = groups["events"].isel(event=slice(count))
        return groups | {"events": events if count else events.drop_attrs(deep=False)}

    return cut


def _is_range(group: xr.Dataset) -> bool:
    return any(str(key).endswith("_min") for key in group)


def _as_samples(group: xr.Dataset) -> xr.Dataset:
    return group.rename({key: str(key)[:-4] for key in group if str(key).endswith("_min")})


def _as_ranges(group: xr.Dataset) -> xr.Dataset:
    if _is_range(group):
        return group
    plain = group.drop_vars("phase", errors="ignore")
    return xr.Dataset({f"{key}_{end}": plain[key] for key in plain for end in ("min", "max")}, attrs=group.attrs)


def _each(change: Callable[[xr.Dataset], xr.Dataset], *but: str) -> Callable[[Groups], Groups]:
    return lambda groups: {
        name: group if name in ("", "events", *but) else change(group) for name, group in groups.items()
    }


def _separates_at(share: float) -> Callable[[Groups], Groups]:
    return lambda groups: root_with(first_separation=share * groups[""]["time_reached"], n_separations=((), 1))(groups)


def growing_in_the_end(groups: Groups) -> Groups:
    """Ranges of the last 20 s a twentieth wider: no motion that has come to rest in a steady state."""
    if "history" not in groups or not _is_range(groups["history"]):
        return groups
    history = groups["history"]
    last = 0.05 * (history["time"] > float(history["time"][-1]) - 20)
    wider = {
        f"{x}_max": history[f"{x}_max"] + last * (history[f"{x}_max"] - history[f"{x}_min"]) for x in ("P", "w_point")
    }
    return groups | {"history": history.assign(wider)}


DAMAGES: Mapping[str, Callable[[Groups], Groups]] = {
    "failed": _failed,
    "nothing recorded": lambda groups: {"": groups[""]},
    "no events": _events_cut(0),
    "three events": _events_cut(3),
    "no envelopes": _each(_as_samples),
    "only envelopes": _each(_as_ranges, "poincare"),
    "empty windows": _each(lambda group: group.isel(time=slice(0))),
    "single samples": _each(lambda group: group.isel(time=slice(1))),
    "two samples": _each(lambda group: group.isel(time=slice(2))),
    "separates at once": _separates_at(1e-3),
    "separates in the end": _separates_at(1.0),
    "nothing moves": _each(lambda group: group.map(xr.zeros_like, keep_attrs=True)),
}
QUICK = {"no events", "no envelopes", "only envelopes", "two samples", "nothing moves"}
EACH_DAMAGE = [pytest.param(one, marks=() if one in QUICK else pytest.mark.slow) for one in DAMAGES]
"""A few of them in the quick tests."""
