"""Rows on Section 4.4, frequencies and how they change with time, and on the conclusions."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.data.dataset import Missing
from disc_model.disc.plate import coupled_natural_frequencies, plate_modes
from disc_model.paper import measures
from disc_model.paper.measures import HIGH, LOW, Array, CaseView, rate_text, sliding_growth
from disc_model.paper.model import AMBIGUOUS, FALSE, PART, TRUE, Answer, graded
from disc_model.paper.paper_tables import (
    COMBINED,
    SEARCHED,
    UNNAMED,
    stick_slip_rate,
    table_2,
    table_2_lines,
)
from disc_model.paper.section2 import BASE
from disc_model.paper.section43 import plane
from disc_model.parameters import Parameters

EARLY, LATER, LATE = (
    ("spectrum_a", 0.0, 10.0),
    ("spectrum_b", 38.0, 48.0),
    ("spectrum_d", 100.0, 110.0),
)
"""Windows of N = 385 N, 15.1 rad/s, and their stretches that are compared, s."""


def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    off = abs(case["first_separation"] - printed)
    return Answer(off <= within, contact=case.contact.capitalize())


def rest_late(case: CaseView, *, within: float) -> Answer:
    drifts = [_drift(case, *stretch) for stretch in (EARLY, LATE)]
    return Answer(
        graded(each.high > within for each in drifts), drifts=drifts, first=case["first_separation"]
    )


def _drift(case: CaseView, window: str, start: float, stop: float) -> measures.Range:
    """How far the lines move between the halves of a stretch of time, at least and at most, Hz."""
    half = (start + stop) / 2
    first, second = (
        case.signal(window, *x).lines(above=LOW, floor=1e-2) for x in ((start, half), (half, stop))
    )
    return measures.extent(min(abs(a.frequency - b.frequency) for b in second) for a in first)


def constant_by_separation(case: CaseView, bonded: CaseView, *, within: float) -> Answer:
    drift, other = (_drift(each, *LATE).high for each in (case, bonded))
    return Answer(
        FALSE if drift > within else PART if other <= within else TRUE, drift=drift, other=other
    )


def lines(case: CaseView, *, bound: float) -> Answer:
    lines, table, signal = table_2_lines(case), table_2(case), case.signal(*EARLY)
    off = np.abs(table["ours_Hz"] - table["paper_Hz"])
    chance = len(lines) * max(
        spectra.chance(signal.time, signal.values, line, SEARCHED) for line in lines
    )
    rows = [f"{row.ours_Hz:.2f} ({row.paper_Hz:g}, {row.ours_is})" for row in table.itertuples()]
    named, rate, most = (table["ours_is"] != UNNAMED).sum(), stick_slip_rate(case), off.max()
    return Answer(most <= bound and chance <= 1e-3, off=most, named=named, rate=rate, rows=rows)


def follow(*cases: CaseView, within: float) -> Answer:
    off, shifted, natural = list[float](), list[bool](), list[bool]()
    for case in cases:
        lines = sorted(case.signal(*EARLY).lines(6, above=100, below=300, apart=1.0))
        rate = stick_slip_rate(case)
        names = [spectra.identify(line.frequency, rate, case.drive) for line in lines]
        off, shifted = (
            off + [abs(each.deviation) for each in names],
            shifted + [each.m != 0 for each in names],
        )
        beside = np.add.outer(
            natural_frequencies(case), case.drive * np.array([-3, -2, -1, 1, 2, 3])
        )
        natural += [bool(np.min(np.abs(beside - line.frequency)) <= within) for line in lines]
    combined = [each <= within for each in off]
    verdict = TRUE if all(natural) else PART if all(combined) and np.mean(shifted) >= 0.5 else FALSE
    return Answer(verdict, combined=combined, shifted=shifted, natural=natural)


def inplane_frequency(case: CaseView, *, printed: float, within: float) -> Answer:
    rate, pair = stick_slip_rate(case), table_2(case).iloc[1:3]
    frequencies, names, holds = (
        [*pair["ours_Hz"]],
        [*pair["ours_is"]],
        abs(rate - printed) <= within,
    )
    free = "" if holds else float(np.sqrt(case["k_p"] / case["m"])) / (2 * np.pi)
    verdict = graded([names == ["f_s − f_Ω", "f_s + f_Ω"], holds])
    return Answer(verdict, rate=rate, drive=case.drive, lines=frequencies, names=names, free=free)


def close_to_natural(case: CaseView, *, within: float) -> Answer:
    natural, computed = natural_frequencies(case), table_2(case)["ours_Hz"].to_numpy()[3:]
    nearest = np.array([natural[np.argmin(np.abs(natural - f))] for f in computed])
    far = np.abs(nearest - computed) > within
    verdict = TRUE if not far.any() else PART if far.mean() <= 0.5 else FALSE
    rows = [f"{f:.1f} Hz ({n:.1f} Hz)" for f, n in zip(computed, nearest, strict=True)]
    return Answer(verdict, rows=rows, far=(far.sum(), far.size))


def higher(
    *cases: CaseView, factor: float, floor: float, windows: str, spans: Sequence[float]
) -> Answer:
    """In `spans` what is compared begins before the separation of each pair's first case, and ends
    after it, s."""
    rows, rises = [], []
    pairs = zip(cases[::2], cases[1::2], windows.split(), spans[::2], spans[1::2], strict=True)
    for case, bonded, window, low, high in pairs:
        first = case["first_separation"]
        (before, after), (ignored, control) = (
            [each.signal(window, *span).power_above(HIGH) for span in ((low, first), (first, high))]
            for each in (case, bonded)
        )
        rises.append([after > max(factor * before, floor), control > max(factor * ignored, floor)])
        rows.append((case.place, before, after, control, low, first, high))
    rise, alone = zip(*rises, strict=True)
    return Answer(FALSE if not all(rise) else PART if any(alone) else TRUE, rows=rows)


def fuzz_goes(*pair: CaseView, share: float) -> Answer:
    filled = [case.signal(*span).filled for case in pair for span in (LATER, LATE)]
    return Answer(filled[1] < share * filled[0], filled=filled)


def explained_by_slider(*pair: CaseView, share: float) -> Answer:
    first = pair[0]["first_separation"]
    length = first - 50
    begins = (("spectrum_c", 50.0), ("spectrum_c", first), ("spectrum_d", 100.0))
    disc = [[case.signal(*span).filled for span in (LATER, LATE)] for case in pair]
    slider = [
        [case.signal(name, start, start + length, "psi").filled for name, start in begins]
        for case in pair
    ]
    clear, alike = ([each[-1] < share * each[0] for each in filled] for filled in (disc, slider))
    return Answer(PART if clear[0] and clear == alike else FALSE, disc=disc, slider=slider)


def later_periodic(case: CaseView, bonded: CaseView) -> Answer:
    periodic, other = (each.late_motion.period > 0 for each in (case, bonded))
    return Answer(periodic, motion=case.motion, span=case.kept_span, other=bonded.motion * other)


def growth_stages(case: CaseView, *, factor: float, least: float) -> Answer:
    first, end = case["first_separation"], case["time_reached"]
    if not 20 <= first <= end - 20:
        raise Missing(
            f"case {case.name} does not run for 20 s both before and after its first separation"
        )
    starts = np.arange(5.0, first - 5, 2.5)
    rates = np.array([case.slope("w_point", t, t + 5) for t in starts])
    slow, sharp = float(rates[starts < first / 2].mean()), float(rates.max())
    last, after = case.slope("w_point", first - 3, first), case.slope("w_point", end - 20, np.inf)
    verdict, when = sharp > max(factor * slow, least) and last < sharp, starts[rates.argmax()] + 2.5
    return Answer(verdict, rates=(slow, sharp, last, after), when=when, first=first)


def fuzz_stays(*pair: CaseView, share: float) -> Answer:
    first = pair[0]["first_separation"]
    spans = (("spectrum_d", first - 4, first), ("spectrum_d", first, first + 4))
    filled = [case.signal(*span).filled for case in pair for span in spans]
    return Answer(filled[1] >= share * filled[0], filled=filled, first=first)


def no_high_line(case: CaseView, *, share: float, printed: float) -> Answer:
    omega = float(plate_modes(case.parameters)["omega"].max())
    spans = (("spectrum_d", 465, 475), ("spectrum_late", 1490, 1500))
    first, last = (case.signal(*span).power_above(omega / (2 * np.pi)) for span in spans)
    verdict = FALSE if max(first, last) >= share else TRUE if abs(omega - printed) <= 0.01 else PART
    return Answer(verdict, shares=(first, last), omega=omega, base=BASE.E)


def inplane_contribution(case: CaseView, *, share: float) -> Answer:
    rate, drive = stick_slip_rate(case), case.drive

    def combined(frequency: float) -> bool:
        return abs(spectra.identify(frequency, rate, drive).deviation) <= COMBINED

    lines = case.signal(*EARLY).lines(above=LOW, below=HIGH, floor=1e-3)
    made = [line for line in lines if combined(line.frequency)]
    part = sum(line.amplitude**2 for line in made) / sum(line.amplitude**2 for line in lines)
    counts, near = (
        (len(made), len(lines)),
        np.mean([combined(f) for f in np.arange(LOW, HIGH, 0.2)]),
    )
    return Answer(part > share, counts=counts, rate=rate, drive=drive, part=part, near=near)


def natural_frequencies(case: CaseView) -> Array:
    """Natural frequencies with the slider attached, Hz."""
    return np.asarray(coupled_natural_frequencies(case.parameters) / (2 * np.pi))


# ---- The conclusions, as far as the rows on the sections do not judge them
def caused_by_friction(*cases: CaseView, growth: float) -> Answer:
    smooth = [sliding_growth(case.parameters.replace(mu_s=0.0, mu_k=0.0)) for case in cases]
    apart = any(case.separates and rate < growth for case, rate in zip(cases, smooth, strict=True))
    return Answer(apart, rows=[case.fate for case in cases], most=max(smooth))


def not_monotonous(*evidence: Any) -> Answer:
    *cases, study = evidence
    loads, damping, apart, growth = plane(study, "N", "c_p")
    newly = (apart & ~apart[:, :1]).any(axis=1)
    growing = (growth[:, 0] > 0) & np.isfinite(growth[:, -1])
    lowered = growing & (growth[:, -1] < growth[:, 0])
    [rates], words = stiffened(cases[0].parameters.replace(N=300), 50)
    load = [(case.separates, case.growth_rate > 0) for case in cases] == [
        (False, False),
        (True, True),
        (False, False),
    ]
    both_ways = all([load, newly.any(), lowered.any(), {-1, 1} <= {*np.sign(np.diff(rates))}])
    fates, most, counts = [case.fate for case in cases], damping[-1], (lowered.sum(), growing.sum())
    return Answer(
        both_ways, fates=fates, most=most, newly=[*loads[newly]], counts=counts, stiffened=words
    )


def damping_destabilises(study: xr.Dataset, *, fewest: float) -> Answer:
    loads, damping, apart, _ = plane(study, "N", "c_p")
    newly = loads[(apart & ~apart[:, :1]).any(axis=1) & (loads >= fewest)]
    return Answer(newly.size > 0, most=damping[-1], rows=[*newly])


def stiffer_inplane(case: CaseView) -> Answer:
    known, words = stiffened(case.parameters, 20, 50)
    growing = [rates[: np.argmax(np.append(rates, -1) < 0)] for rates in known]
    rises = [rates.size > 1 and bool((np.diff(rates) > 0).all()) for rates in growing]
    return Answer(graded(rises), rises=rises, stiffened=words)


STIFFENED = (2, 20, 30, 36, 47, 55, 63, 73, 84, 130, 200)
"""In-plane stiffnesses, kN/m: those of the paper, and others between them."""


def stiffened(p: Parameters, *speeds: float) -> tuple[list[Array], str]:
    """Growth rates of the cycles that there are with `STIFFENED`, 1/s, for each speed in rad/s; and
    all in words."""
    known, words = [], []
    for speed in speeds:
        rates = np.array(
            [measures.growth_of(p.replace(k_p=1e3 * k_p, Omega=speed)) for k_p in STIFFENED]
        )
        told = "; ".join(
            f"{rate_text(rate)} at {k_p}" for k_p, rate in zip(STIFFENED, rates, strict=True)
        )
        words.append(
            f"At {measures.place(p.N, speed)}, growth (1/s) at each k_p (kN/m) is as follows: {told}."
        )
        known.append(rates[np.isfinite(rates)])
    return known, " ".join(words)


def soft_enough(study: xr.Dataset, *, slow: float) -> Answer:
    E, Omega, apart, _ = plane(study, "E", "Omega")
    E, some, at_slow = E / 1e9, apart.any(axis=1), apart[:, Omega == slow]
    quiet = [*E[~some]]
    softer = [*E[some & (max(quiet, default=0.0) > E)]]
    soft = at_slow[E <= BASE.E / 1e9]
    calm = slow if soft.size and not soft.any() else ""
    verdict = FALSE if not (quiet and some.any()) else AMBIGUOUS if softer else TRUE
    return Answer(verdict, quiet=quiet, softer=softer, slow=calm, base=BASE.E)


def vertical_branch(*cases: CaseView, within: float) -> Answer:
    rows, follows, alone = [], [], []
    free = float(np.sqrt(cases[0]["k"] / cases[0]["m"])) / (2 * np.pi)
    for pair in zip(cases[::2], cases[1::2], strict=True):
        rates = [1 / float(case.intervals("separation").mean()) for case in pair]
        modes = [natural_frequencies(case)[0] for case in pair]
        rise, of_mode = rates[1] / rates[0] - 1, modes[1] / modes[0] - 1
        follows.append(rise / of_mode)
        alone.append(rise / (math.sqrt(pair[1]["k"] / pair[0]["k"]) - 1))
        rows.append((pair[0].place, rates[0]))
    by_mode, by_spring = (
        all(abs(each - 1) <= within for each in rises) for rises in (follows, alone)
    )
    told = {"coupled": modes[0], "free": free, "follows": follows}
    return Answer(AMBIGUOUS if by_mode or by_spring else False, rows=rows, **told)
