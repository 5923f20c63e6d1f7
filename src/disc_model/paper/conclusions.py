"""Rows on the conclusions, as far as those on the sections do not judge them."""

import math
from typing import Any

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.paper import measures
from disc_model.paper.measures import CaseView, facts, listed, mm, pairs, published, sliding_growth
from disc_model.paper.model import AMBIGUOUS, Answer
from disc_model.paper.section2 import BASE
from disc_model.paper.section41 import smaller_range
from disc_model.paper.section42 import unstable_means_separation
from disc_model.paper.section43 import _map, damping_stabilises, outcome_of, stiffened, stiffened_text
from disc_model.paper.section44 import natural_frequencies

__all__ = ["damping_stabilises", "smaller_range", "unstable_means_separation"]  # which the texts name as well


def caused_by_friction(*cases: CaseView, growth: float) -> Answer:
    """Whether some cases separate for which sliding without friction is stable."""
    smooth = [sliding_growth(case.parameters.replace(mu_s=0.0, mu_k=0.0)) for case in cases]
    rows = [
        f"{case.place}: {case.first_separation()}, largest growth rate without friction {rate:.0e}/s"
        for case, rate in zip(cases, smooth, strict=True)
    ]
    return Answer(
        any(case.separates and rate < growth for case, rate in zip(cases, smooth, strict=True)), f"{'; '.join(rows)}."
    )


def very_different(*cases: CaseView, factor: float) -> Answer:
    rows, differ = [], []
    for case, bonded in pairs(cases):
        shares = case.stick, bonded.stick
        narrow = measures.width_ratio(case, bonded) * factor <= 1
        differ.append(narrow and max(shares) >= factor * min(shares))
        rows.append(
            f"{case.place}: sticks {100 * shares[0]:.1f} instead of {100 * shares[1]:.1f} % of the time, and the range "
            f"of the disc is {mm(case.disc.width)} instead of {mm(bonded.disc.width)}"
        )
    return Answer(any(differ), f"With separation instead of without: {'; '.join(rows)}.")


def not_monotonous(*evidence: Any) -> Answer:
    """Whether each of three parameters acts both ways; damping by new separations, and by lower growth."""
    *cases, study = evidence
    loads, damping, apart = _map(study, "N", "c_p")
    growth = published(study)["growth_rate"].sortby(["N", "c_p"]).transpose("N", "c_p").values
    newly = (apart & ~apart[:, :1]).any(axis=1)
    growing = (growth[:, 0] > 0) & np.isfinite(growth[:, -1])
    lowered = growing & (growth[:, -1] < growth[:, 0])
    p = cases[0].parameters.replace(N=300)
    rates = stiffened(p, "k_p", 50)[50]
    signs = {*np.sign(np.diff(rates[np.isfinite(rates)]))}
    preloads = "; ".join(f"{case['N']:g} N: {outcome_of(case)}" for case in cases)
    return Answer(
        [case.separates for case in cases] == [False, True, False]
        and newly.any()
        and lowered.any()
        and {-1, 1} <= signs,
        f"Preload at {cases[0]['Omega']:g} rad/s: {preloads}. In-plane damping of up to {damping[-1]:g} N s/m brings "
        f"separation at {listed(loads[newly], '.0f')} N and lowers growth at {lowered.sum()} of {growing.sum()} "
        f"preloads with a growing cycle. In-plane stiffness at 300 N: growth {stiffened_text(p, 'k_p', 50)}.",
    )


def damping_destabilises(study: xr.Dataset, *, fewest: float) -> Answer:
    """Whether in-plane damping brings separation, or raises growth, at some large preloads."""
    loads, damping, apart = _map(study, "N", "c_p")
    newly = loads[(apart & ~apart[:, :1]).any(axis=1)]
    large = newly[newly >= fewest]
    growth = published(study)["growth_rate"].sortby(["N", "c_p"]).transpose("N", "c_p").values
    both = np.isfinite(growth[:, 0]) & np.isfinite(growth[:, -1])
    lower = int((both & (growth[:, -1] < growth[:, 0])).sum())
    return Answer(
        bool(large.size),
        f"At {facts(study)['Omega']:g} rad/s, some damper of up to {damping[-1]:g} N s/m brings separation at "
        f"{listed(large, '.0f', 'no')} N.",
        f"Elsewhere it damps: growth is lower at {lower} of {both.sum()} preloads with a cycle both without and with "
        "it.",
    )


def stiffer_inplane(case: CaseView) -> Answer:
    """Whether growth rises with each stiffness up to its largest value."""
    results = stiffened(case.parameters, "k_p", 20, 50).values()
    known = [rates[np.isfinite(rates)] for rates in results]
    rising = [bool(np.all(np.diff(rates[: np.argmax(rates) + 1]) > 0)) for rates in known]
    return Answer(all(rising), f"At {case['N']:g} N growth is {stiffened_text(case.parameters, 'k_p', 20, 50)}.")


def soft_enough(study: xr.Dataset, *, slow: float) -> Answer:
    """Whether discs from some softness on do not separate at any speed, while stiffer ones do."""
    E, Omega, apart = _map(study, "E", "Omega")
    E, some = E / 1e9, apart.any(axis=1)
    quiet = E[~some]
    softer = E[some & (quiet.max(initial=0.0) > E)] if quiet.size else E[:0]
    stated = facts(study)
    at_slow = apart[E <= BASE.E / 1e9][:, Omega == slow]
    return Answer(
        bool(quiet.size) and bool(some.any()) and not softer.size,
        f"At {stated['N']:g} N, within {stated['horizon']:g} s, {listed(quiet, '.4g', 'no')} GPa separate at no "
        "speed of the map. " + (f"Softer discs do: {listed(softer, '.4g')} GPa." if softer.size else ""),
        f"At the {slow:g} rad/s of Fig. 21 the base disc does not separate either, so that figure shows nothing about "
        "softness."
        if at_slow.size and not at_slow.any()
        else "",
    )


def vertical_branch(*cases: CaseView, within: float) -> Answer:
    """Whether the rate of separations rises with a stiffer spring as the frequency of slider and spring alone does.

    Ambiguous if it rises as that of the mode in which they move with the disc.
    """
    rows, follows, alone = [], [], []
    for pair in zip(cases[::2], cases[1::2], strict=True):
        rates = [1 / float(case.intervals("separation").mean()) for case in pair]
        modes = [natural_frequencies(case)[0] for case in pair]
        rise, of_mode = rates[1] / rates[0] - 1, modes[1] / modes[0] - 1
        follows.append(rise / of_mode)
        alone.append(rise / (math.sqrt(pair[1]["k"] / pair[0]["k"]) - 1))
        spring = 2 * of_mode / (pair[1]["k"] / pair[0]["k"] - 1)
        rows.append(f"{pair[0].place}: {rates[0]:.3f} separations/s, coupled mode at {modes[0]:.3f} Hz")
    p = cases[0].parameters
    free = float(np.sqrt(p.k / p.m)) / (2 * np.pi)
    level = max(_level(case, free) for case in cases[::2])
    by_mode = all(abs(each - 1) <= within for each in follows)
    return Answer(
        AMBIGUOUS if by_mode else all(abs(each - 1) <= within for each in alone),
        f"{'; '.join(rows)}. With k 0.1 % larger the rate rises by {listed(follows, '.3f')} of what the coupled mode "
        f"does. The spring has {100 * spring:.0f} % of the stiffness of that mode. At sqrt(k/m) = {free:.1f} Hz the "
        f"disc's spectrum has {level:.0e} of its strongest line or less.",
        "If the branch is the mode in which slider and spring move with the disc, the sentence is true. If it is the "
        "slider on its spring alone, it is false."
        if by_mode
        else "",
    )


def _level(case: CaseView, frequency: float) -> float:
    """Largest amplitude of the disc's point within 1 Hz of a frequency, relative to that of all above 1 Hz."""
    signal = case.signal("late", 0.0, np.inf)
    frequencies, amplitude = spectra.amplitude_spectrum(signal.time, signal.values)
    near, every = (float(amplitude[band].max()) for band in (np.abs(frequencies - frequency) < 1, frequencies > 1))
    return measures.ratio(near, every, f"the spectrum of case {case.name}")
