"""Measures for rows on Section 4.4, frequencies and how they change with time, and on the
conclusions."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.arrays import Mask
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.modes import plate_modes
from workflow.paper import growth, measures, paper_tables, signals
from workflow.paper.measures import HIGH, LOW, Array, Cases, CaseView, Found
from workflow.paper.section2 import BASE, coupled
from workflow.paper.section43 import plane


class Stretch(NamedTuple):
    """A stretch of a window, s."""

    window: str
    start: float
    stop: float


EARLY = Stretch("spectrum_a", 0.0, 10.0)
LATER = Stretch("spectrum_b", 38.0, 48.0)
LATE = Stretch("spectrum_d", 100.0, 110.0)
"""Stretches of the motion at N = 385 N, 15.1 rad/s that are compared."""
EARLY_LENGTH = 10.0
"""Length of the stretch of the window ``early`` whose spectrum is taken, s."""
TURN = 2 * math.pi
STIFFENED = (2, 20, 30, 36, 47, 55, 63, 73, 84, 130, 200)
"""In-plane stiffnesses, kN/m: those of the paper, and others between them."""


def natural_frequencies(case: CaseView) -> Array:
    """Return natural frequencies with the slider attached, Hz."""
    return coupled(case.parameters) / (2 * np.pi)


# ---- Lines of the spectrum


def drift(case: CaseView, stretch: Stretch) -> measures.Range:
    """Return how far lines move between the halves of a stretch, at least and at most, Hz."""
    window, start, stop = stretch
    half = (start + stop) / 2
    first = case.signal(window, start, half).lines(above=LOW, floor=1e-2)
    second = case.signal(window, half, stop).lines(above=LOW, floor=1e-2)
    later = np.array([line.frequency for line in second])
    return measures.extent(np.min(np.abs(later - line.frequency)) for line in first)


def chance(case: CaseView) -> float:
    """Return a bound on the probability that noise makes a line of Table 2 where one is found."""
    signal = case.signal(*EARLY)
    found = paper_tables.table_2_lines(case)
    width = paper_tables.SEARCHED
    return len(found) * max(
        signals.chance(signal.time, signal.values, line, width) for line in found
    )


def strongest_lines(cases: Cases, within: float) -> dict[str, list[bool]]:
    """Say of the six strongest lines between 100 and 300 Hz of each case what they are.

    Parameters
    ----------
    cases : the runs
    within : Hz by which lines may differ

    Returns
    -------
    dict
        Whether they are ``combined`` of the stick-slip rate and the drive's frequency, ``shifted`` by
        the latter, and ``natural`` frequencies that are shifted.
    """
    found: dict[str, list[bool]] = {"combined": [], "shifted": [], "natural": []}
    orders = np.array([-3, -2, -1, 1, 2, 3])
    for case in cases:
        rate = paper_tables.stick_slip_rate(case)
        expected = np.add.outer(natural_frequencies(case), case.drive * orders)
        for line in sorted(case.signal(*EARLY).lines(6, above=100, below=300, apart=1.0)):
            name = spectra.identify(line.frequency, rate, case.drive)
            found["combined"].append(abs(name.deviation) <= within)
            found["shifted"].append(name.m != 0)
            found["natural"].append(bool(np.min(np.abs(expected - line.frequency)) <= within))
    return found


def own_frequency(stiffness: float, mass: float) -> float:
    """Return the natural frequency of a mass on a spring, Hz."""
    return math.sqrt(stiffness / mass) / (2 * math.pi)


def nearest_natural(case: CaseView) -> list[tuple[float, float]]:
    """Return the six higher lines of Table 2, each with the nearest natural frequency, Hz."""
    natural = natural_frequencies(case)
    lines = paper_tables.table_2(case)["ours_Hz"].to_numpy()[3:]
    return [(line, natural[np.argmin(np.abs(natural - line))]) for line in lines]


def far_apart(lines: Sequence[tuple[float, float]], within: float) -> int:
    """Return how many of such lines differ from the nearest frequency by more than a number of Hz."""
    return sum(abs(line - natural) > within for line, natural in lines)


def power_at(
    case: CaseView,
    stretch: Stretch,
    belongs: Callable[[float], bool],
    above: float = LOW,
    below: float = math.inf,
) -> Found:
    """Measure which ``part`` of the power of lines belongs to some frequencies.

    Parameters
    ----------
    case, stretch : where the lines are
    belongs : whether a frequency in Hz is one of them
    above, below : Hz, between which the lines are

    Returns
    -------
    dict
        With it ``counts`` of lines that belong and of all lines, the frequencies of the two
        ``strongest``, and which part of the band to `HIGH` is ``near`` such a frequency.
    """
    found = case.signal(*stretch).lines(above=above, below=below, floor=1e-3)
    power = np.array([line.amplitude**2 for line in found])
    chosen = np.array([belongs(line.frequency) for line in found])
    strongest = sorted(found, key=lambda line: -line.amplitude)[:2]
    return {
        "part": sum(power[chosen]) / sum(power),
        "counts": (chosen.sum(), chosen.size),
        "strongest": sorted(line.frequency for line in strongest),
        "near": np.mean([belongs(frequency) for frequency in np.arange(LOW, HIGH, 0.2)]),
    }


def inplane_power(case: CaseView) -> Found:
    """Measure the power at combinations of the stick-slip rate and the drive: `power_at`."""
    rate = paper_tables.stick_slip_rate(case)
    return {"rate": rate, **power_at(case, EARLY, combinations_of(case, rate), below=HIGH)}


def combinations_of(case: CaseView, rate: float, least: int = 0) -> Callable[[float], bool]:
    """Return whether a frequency is n `rate` + m times the drive's, Hz, where n is at least some number."""

    def is_combination(frequency: float) -> bool:
        name = spectra.identify(frequency, rate, case.drive)
        return abs(name.deviation) <= paper_tables.COMBINED and name.n >= least

    return is_combination


def power_of_combinations(case: CaseView) -> Found:
    """Measure the disc's power at combinations of stick-slip rate and drive before it separates.

    Returns
    -------
    dict
        The ``span`` of time, s; the ``rate``, Hz; shares of the power that combinations have
        (``part``), and those in which the rate takes part (``with_rate``).
    """
    start = float(case.samples("early")["time"].values[0])
    stretch = Stretch("early", start, start + EARLY_LENGTH)
    first = case["first_separation"]
    if not stretch.stop < first:
        raise Missing(f"case {case.name} separates at {first:g} s, before {stretch.stop:g} s")
    rate = case.signal(*stretch, "psi").lines(1, above=2 * case.drive)[0].frequency
    parts = [power_at(case, stretch, combinations_of(case, rate, n), 1.0)["part"] for n in (0, 1)]
    return {"span": stretch[1:], "rate": rate, "part": parts[0], "with_rate": parts[1]}


def natural_power(case: CaseView, within: float, turns: float) -> Found:
    """Measure the power at natural frequencies before separation: `power_at`.

    A point fixed on the disc sees them shifted by multiples of the drive's frequency.

    Parameters
    ----------
    case : the run, with the window ``spectrum_d``
    within : Hz within which a line is at such a frequency
    turns : greatest multiple of the drive's frequency
    """
    stretch = Stretch("spectrum_d", case["first_separation"] - 4.0, case["first_separation"])
    multiples = case.drive * np.arange(-turns, turns + 1)
    natural = natural_frequencies(case)
    expected = np.add.outer(natural, multiples).ravel()

    def is_natural(frequency: float) -> bool:
        return bool(np.min(np.abs(expected - frequency)) <= within)

    rate = case.signal(*stretch, "psi").lines(1, above=LOW)[0].frequency
    found = power_at(case, stretch, is_natural)
    return {"span": stretch[1:], "coupled": natural[0], "rate": rate, **found}


# ---- Power at high frequencies, and fuzz between lines


def power_above(case: CaseView, window: str, start: float, stop: float) -> float:
    """Return the share of power above `HIGH` in a stretch of a window, s."""
    return case.signal(window, start, stop).power_above(HIGH)


def risen_power(
    cases: Cases, factor: float, floor: float, windows: Sequence[str], spans: Sequence[float]
) -> Found:
    """Measure power above `HIGH` before and after the first separation.

    Parameters
    ----------
    cases : with separation and without it, in turn
    factor : by which the share of power must rise
    floor : share of power that must be reached
    windows : names of the windows to look in, one for each pair
    spans : for each pair, when what is compared begins before the first separation, and when it
        ends after it, s

    Returns
    -------
    dict
        ``rows`` of shares and times, and whether the share ``rises``, and ``also`` without separation.
    """
    rows = []
    risen: list[list[bool]] = [[], []]
    places = zip(cases[::2], cases[1::2], windows, spans[::2], spans[1::2], strict=True)
    for case, bilateral, window, low, high in places:
        first = case["first_separation"]
        shares = []
        for each, of_each in zip((case, bilateral), risen, strict=True):
            before = power_above(each, window, low, first)
            after = power_above(each, window, first, high)
            of_each.append(after > max(factor * before, floor))
            shares += [before, after]
        rows.append((case.place, shares[0], shares[1], shares[3], low, first, high))
    return {"rows": rows, "rises": risen[0], "also": risen[1]}


def filled(
    case: CaseView, *stretches: tuple[str, float, float], name: str = "w_point"
) -> list[float]:
    """Return the share of the band that the spectrum of a variable fills in stretches."""
    return [case.signal(*stretch, name).filled for stretch in stretches]


# ---- Stages of the motion


def growth_stages(case: CaseView) -> Found:
    """Measure growth rates of the disc's range before the first separation and at the end, 1/s.

    Returns
    -------
    dict
        ``rates``: the mean of the first half, the greatest, that of the last 3 s, and that in the
        end; and ``when`` the greatest is, s.
    """
    first = case["first_separation"]
    end = case["time_reached"]
    if not 20 <= first <= end - 20:
        raise Missing(
            f"case {case.name} does not run for 20 s both before and after its first separation"
        )
    starts = np.arange(5.0, first - 5, 2.5)
    rates = np.array([case.slope("w_point", t, t + 5) for t in starts])
    slow = float(rates[starts < first / 2].mean())
    last = case.slope("w_point", first - 3, first)
    after = case.slope("w_point", end - 20, np.inf)
    return {"rates": (slow, float(rates.max()), last, after), "time": starts[rates.argmax()] + 2.5}


# ---- The conclusions, as far as the rows on the sections do not judge them


def reattachments(cases: Cases, longest: float) -> Found:
    """Count separations that begin a time in s before the end of a run, and those that end there.

    Returns
    -------
    dict
        Numbers that ``begin`` and ``end`` in each run, and the length of the longest, ms.
    """
    begin = []
    end = []
    lasts = 0.0
    for case in cases:
        starts = case.times_of("separation")
        starts = starts[starts <= case.kept_span.high - longest]
        if not starts.size:
            raise Missing(f"case {case.name} keeps no separation")
        contacts = case.times_of("reattachment")
        following = np.searchsorted(contacts, starts)
        ended = following < contacts.size
        durations = contacts[following[ended]] - starts[ended]
        lasts = max(lasts, float(durations.max(initial=0.0)))
        begin.append(starts.size)
        end.append(int(ended.sum()))
    return {"begin": begin, "end": end, "lasts": 1e3 * lasts}


def damping_both_ways(study: xr.Dataset) -> tuple[int, int]:
    """Return at how many preloads the largest damping of a map lowers growth, and how many count.

    Those count that have a growing cycle without damping, and a cycle with the largest.
    """
    rates = plane(study, "N", "c_p").growth
    growing = (rates[:, 0] > 0) & np.isfinite(rates[:, -1])
    return (growing & (rates[:, -1] < rates[:, 0])).sum(), growing.sum()


def stiffened(case: CaseView, *speeds: float, **changes: Any) -> Found:
    """Measure growth rates with `STIFFENED`.

    Parameters
    ----------
    case : the case
    speeds : at which it is computed, rad/s
    changes : other parameters

    Returns
    -------
    dict
        All rates in words, as ``stiffened``; signs of the ``steps`` from each cycle to the next; and
        whether growth ``rises`` in each until it is negative, at each speed.
    """
    sentences = []
    rises = []
    steps: Array = np.empty(0)
    for speed in speeds:
        p = case.parameters.replace(Omega=speed, **changes)
        rates = np.array([growth.growth_of(p.replace(k_p=1e3 * k_p)) for k_p in STIFFENED])
        words = [
            f"{measures.rate_text(rate)} at {k_p}"
            for rate, k_p in zip(rates, STIFFENED, strict=True)
        ]
        sentences.append(
            f"At {measures.place(p.N, speed)}, growth (1/s) at each k_p (kN/m) is as follows: "
            f"{'; '.join(words)}."
        )
        known = rates[np.isfinite(rates)]
        steps = np.diff(known)
        until_decay = steps[: max(np.argmax(np.append(known, -1) < 0) - 1, 0)]
        rises.append(until_decay.size > 0 and bool((until_decay > 0).all()))
    return {"stiffened": " ".join(sentences), "steps": [*np.sign(steps)], "rises": rises}


def discs_in_contact(study: xr.Dataset, slow: float) -> Found:
    """Find discs that keep contact at every speed, on a map of elastic modulus and speed.

    Parameters
    ----------
    study : the map
    slow : a speed, rad/s

    Returns
    -------
    dict
        Moduli in GPa of discs that are ``quiet``, of ``softer`` ones that lose contact, whether there
        are others that lose it (``some``), and whether all discs up to that of Table 1 keep contact at
        the slow speed (``example``).
    """
    modulus, Omega, separates, *_ = plane(study, "E", "Omega")
    modulus = modulus / 1e9
    some = separates.any(axis=1)
    quiet = modulus[~some]
    no_stiffer = modulus <= BASE.E / 1e9
    at_slow = separates[no_stiffer][:, Omega == slow]
    return {
        "quiet": [*quiet],
        "softer": [*modulus[some & (modulus < quiet.max(initial=0.0))]],
        "some": bool(some.any()),
        "example": at_slow.size > 0 and not at_slow.any(),
    }


def vertical_branch(cases: Cases) -> Found:
    """Compare rises of the rate of separations with those of two frequencies normal to the disc.

    These are that of the coupled mode, and that of the slider on its spring alone.

    Parameters
    ----------
    cases : in pairs, the second with a stiffer spring k

    Returns
    -------
    dict
        For each pair, rises of the rate over those of the mode and over those of the spring.
    """
    over_mode = []
    over_spring = []
    for soft, stiff in zip(cases[::2], cases[1::2], strict=True):
        rate, stiffer = (1 / float(case.intervals("separation").mean()) for case in (soft, stiff))
        mode, stiffer_mode = (natural_frequencies(case)[0] for case in (soft, stiff))
        rise = stiffer / rate - 1
        over_mode.append(rise / (stiffer_mode / mode - 1))
        over_spring.append(rise / (math.sqrt(stiff["k"] / soft["k"]) - 1))
    return {"over_mode": over_mode, "over_spring": over_spring}


def equal_to_one(values: Sequence[float], within: float) -> bool:
    """Return whether all of some numbers are 1, up to a difference."""
    return all(abs(each - 1) <= within for each in values)


def errors_without_separation(cases: Cases, study: xr.Dataset, within: float) -> Found:
    """Count ranges that come out wrong if separation is ignored, on two discs.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    study : the study of the brake-like disc
    within : share by which a range must differ

    Returns
    -------
    dict
        Numbers of ranges that are too large and too small of the paper's ``disc`` and ``slider``, and
        on the ``brake``-like disc; ``shares`` of motions with a wrong range on both discs; and how many
        motions of the latter separate (``of``), keep contact (``kept``), or have not settled without
        separation (``unsettled``).
    """
    pairs = measures.pairs(cases)
    psi = [[each.late_range("psi").width for each in pair] for pair in pairs]
    disc = _errors(np.array([1 / measures.width_ratio(*pair) for pair in pairs]), within)
    slider = _errors(np.array([other / own for own, other in psi]), within)

    # the brake-like disc: late ranges of the slider's height
    surface = study.sel(disc="surface")
    outcome = surface["outcome"].sel(contact="unilateral")
    width = (surface["u_max"] - surface["u_min"]).reset_coords(drop=True)
    ratios = width.sel(contact="bilateral") / width.sel(contact="unilateral")
    separates = flag_names(outcome) == "separation"
    brake = _errors(ratios.transpose(*outcome.dims).values[separates], within)
    kept_on = flag_names(surface.sel(contact="bilateral")["outcome"])[separates]
    wrong = disc.any(axis=0) | slider.any(axis=0)
    return {
        "pairs": wrong.size,
        "disc": disc.sum(axis=1).tolist(),
        "slider": slider.sum(axis=1).tolist(),
        "brake": brake.sum(axis=1).tolist(),
        "shares": [wrong.mean(), brake.any(axis=0).mean() if separates.any() else 0.0],
        "of": int(separates.sum()),
        "unsettled": int(np.isin(kept_on, ("growing", "undecided")).sum()),
        "kept": int((~separates).sum()),
        "after": stated_in(study, "options")["after_separation"],
    }


def _errors(ratios: Array, within: float) -> Mask:
    """Return which ratios of ranges are too large, and which too small, shape (2, ratios)."""
    return np.stack([ratios > 1 + within, ratios < 1 / (1 + within)])


def highest_frequency(case: CaseView) -> float:
    """Return the highest natural frequency of the disc alone, rad/s."""
    return float(plate_modes(case.parameters)["omega"].max())
