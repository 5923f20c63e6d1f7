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
from disc_model.paper.measures import HIGH, LOW, CaseView, facts, listed, mm, pairs, published, sliding_growth
from disc_model.paper.model import AMBIGUOUS, FALSE, PART, TRUE, Answer, graded
from disc_model.paper.paper_tables import COMBINED, SEARCHED, UNNAMED, stick_slip_rate, table_2, table_2_lines
from disc_model.paper.section2 import BASE, attached_frequencies
from disc_model.paper.section41 import both_at_low_speed, smaller_range
from disc_model.paper.section43 import _map, damping_stabilises, outcome_of, soft_disc, stiffened, stiffened_text

# which the texts name as well
__all__ = ["attached_frequencies", "both_at_low_speed", "damping_stabilises", "smaller_range", "soft_disc"]
EARLY, LATER, LATE = ("spectrum_a", 0.0, 10.0), ("spectrum_b", 38.0, 48.0), ("spectrum_d", 100.0, 110.0)
"""Windows of N = 385 N, 15.1 rad/s, and their stretches that are compared, s."""


def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    off = abs(case["first_separation"] - printed)
    return Answer(
        off <= within,
        f"{case.first_separation().capitalize()}. The paper has {printed:g} s"
        + (f": {off:.2f} s or {100 * off / printed:.2f} % away." if case.separates else "."),
    )


def rest_late(case: CaseView, bonded: CaseView, *, within: float) -> Answer:
    """Whether lines still move long after separation, so that a spectrum of a long record would smear."""
    moved = [_drift(each) for each in (case, bonded)]
    return Answer(
        PART if moved[0] <= within else TRUE,
        f"While the vibration grows lines move. From 100 to 110 s the lines of {case.place} move by {moved[0]:.0e} Hz "
        "at most, so that the usual spectrum is sharp.",
    )


def _drift(case: CaseView) -> float:
    """How far lines move between the halves of the last stretch, at most, Hz."""
    halves = ((100.0, 105.0), (105.0, 110.0))
    first, second = (case.signal("spectrum_d", *half).lines(above=LOW, floor=1e-2) for half in halves)
    return max(min(abs(a.frequency - b.frequency) for b in second) for a in first)


def constant_by_separation(case: CaseView, bonded: CaseView, *, within: float) -> Answer:
    """Whether lines come to rest, and not without separation."""
    drift, other = _drift(case), _drift(bonded)
    verdict = FALSE if drift > within else PART if other <= within else TRUE
    text = f"From 100 to 110 s lines move by {drift:.0e} Hz at most with separation, and by {other:.0e} Hz without."
    return Answer(verdict, text)


def lines(case: CaseView, *, bound: float) -> Answer:
    lines, table, signal = table_2_lines(case), table_2(case), case.signal(*EARLY)
    off = np.abs(table["ours_Hz"] - table["paper_Hz"])
    chance = max(spectra.chance(signal.time, signal.values, line, SEARCHED) for line in lines)
    floor = min(line.amplitude for line in lines) / max(line.amplitude for line in lines)
    others = [
        f"{line.frequency:.2f}"
        for line in signal.lines(above=1.0, below=300.0, floor=floor, apart=1.0)
        if np.min(np.abs(line.frequency - table["ours_Hz"])) > bound
    ]
    named = (table["ours_is"] != UNNAMED).sum()
    rows = ", ".join(f"{row.ours_Hz:.2f} ({row.ours_is})" for row in table.itertuples())
    return Answer(
        off.max() <= bound and chance * len(lines) <= 1e-3,
        f"{rows} Hz, with f_s = {stick_slip_rate(case):.2f} Hz: {off.max():.2f} Hz away at most. {named} of "
        f"{len(lines)} are combinations of the stick-slip rate and the drive's frequency.",
        f"As strong as the weakest of them, but not in the table: {listed(others)} Hz." if others else "",
    )


def follow(*cases: CaseView, within: float) -> Answer:
    """Whether the lines move with the disc's frequencies or with the stick-slip rate when that is changed."""
    rows, off, away = [], [], []
    for case in cases:
        lines = sorted(case.signal(*EARLY).lines(6, above=100, below=300, apart=1.0))
        rate = stick_slip_rate(case)
        off += [_from_combination(case, line, rate) for line in lines]
        natural = natural_frequencies(case)
        away += [float(np.min(np.abs(natural - line.frequency))) / case.drive for line in lines]
        stated = f"k_p = {1e-3 * case['k_p']:g} kN/m, Ω = {case['Omega']:g} rad/s"
        rows.append(f"{stated}, f_s = {rate:.2f} Hz: {listed((line.frequency for line in lines), '.1f')} Hz")
    combined = [each <= within for each in off]
    return Answer(
        max(away) <= 4 and not any(combined),
        f"The lines follow the stick-slip rate f_s: with other in-plane springs and speeds, too, {sum(combined)} of "
        f"{len(combined)} lie within {max(off):.2f} Hz of n f_s + m f_Ω. Natural frequencies do not change, and are up "
        f"to {max(away) * cases[0].drive:.0f} Hz away.",
        f"{'; '.join(rows)}.",
    )


def inplane_frequency(case: CaseView, *, printed: float, within: float) -> Answer:
    rate, free = stick_slip_rate(case), float(np.sqrt(case["k_p"] / case["m"])) / (2 * np.pi)
    slower = f"It is the rate of stick and slip. Sticking makes it slower than the spring's own {free:.2f} Hz."
    pair, holds = table_2(case).iloc[1:3], abs(rate - printed) <= within
    return Answer(
        graded([[*pair["ours_is"]] == ["f_s − f_Ω", "f_s + f_Ω"], holds]),
        f"The lines at {listed(pair['ours_Hz'], '.2f')} Hz are {' and '.join(pair['ours_is'])}: the in-plane "
        f"vibration, split by the rotation. The slider vibrates at f_s = {rate:.2f} Hz.",
        "" if holds else slower,
    )


def close_to_natural(case: CaseView, *, within: float) -> Answer:
    natural, computed = natural_frequencies(case), table_2(case)["ours_Hz"].to_numpy()[3:]
    nearest = np.array([natural[np.argmin(np.abs(natural - f))] for f in computed])
    far = np.abs(nearest - computed) > within
    rows = ", ".join(f"{f:.1f} ({n:.1f})" for f, n in zip(computed, nearest, strict=True))
    return Answer(
        TRUE if not far.any() else PART if far.mean() <= 0.5 else FALSE,
        f"{rows} Hz, in brackets the nearest natural frequency: {far.sum()} of {far.size} are more than {within:g} Hz "
        "away.",
        f"Twice the stick-slip rate is {2 * stick_slip_rate(case):.2f} Hz, near the coupled mode at {natural[0]:.2f} "
        "Hz."
        if 0 < far.sum() < far.size
        else "",
    )


def higher(*cases: CaseView, factor: float, floor: float, windows: str, spans: Sequence[float]) -> Answer:
    """Whether power above the natural frequencies rises with the first separation, and not without separation.

    spans : s, where what is compared begins before the separation of each pair's first case, and ends after it
    """
    rows, rises = [], []
    pairs = zip(cases[::2], cases[1::2], windows.split(), spans[::2], spans[1::2], strict=True)
    for case, bonded, window, low, high in pairs:
        first = case["first_separation"]
        (before, after), (ignored, control) = (
            [each.signal(window, *span).power_above(HIGH) for span in ((low, first), (first, high))]
            for each in (case, bonded)
        )
        rises.append([after > max(factor * before, floor), control > max(factor * ignored, floor)])
        rows.append(f"{case.place}: {before:.1e} before, {after:.1e} after; without separation {control:.1e} then")
    rise, alone = zip(*rises, strict=True)
    return Answer(
        FALSE if not all(rise) else PART if any(alone) else TRUE,
        f"Power above {HIGH:g} Hz, of that above {LOW:g} Hz. {'. '.join(rows)}.",
    )


def fuzz_goes(*pair: CaseView, share: float) -> Answer:
    """Whether lines fill less of the spectrum of the disc later; the control without separation is told."""
    filled = [[case.signal(*span).filled for span in (LATER, LATE)] for case in pair]
    (before, after), (ignored, control) = filled
    return Answer(
        after < share * before,
        f"Lines fill {100 * before:.1f} % of 20 to 300 Hz from 38 to 48 s, and {100 * after:.1f} % from 100 to 110 s. "
        f"Without separation they fill {100 * ignored:.1f} % and {100 * control:.1f} %.",
    )


def explained_by_slider(*pair: CaseView, share: float) -> Answer:
    """Whether what clears the slider's spectrum, and with it the disc's, is separation: not if it clears without."""
    first = pair[0]["first_separation"]
    length = first - 50
    begins = (("spectrum_c", 50.0), ("spectrum_c", first), ("spectrum_d", 100.0))
    (before, after, _), (ignored, control, late) = (
        [case.signal(window, begin, begin + length, "psi").filled for window, begin in begins] for case in pair
    )
    cleared, alike = after < share * before, min(control, late) < share * ignored
    return Answer(
        PART if cleared and alike else cleared,
        f"Lines of ψ fill {100 * before:.1f} % of 20 to 300 Hz before the first separation and {100 * after:.1f} % "
        f"after it. Without separation they fill {100 * ignored:.1f} and {100 * control:.1f} % then, and "
        f"{100 * late:.1f} % from 100 s on.",
    )


def later_periodic(case: CaseView, bonded: CaseView) -> Answer:
    return Answer(
        case.late_motion().period > 0,
        f"The motion is {case.motion}.",
        f"Without separation it is {bonded.motion}." if bonded.late_motion().period else "",
    )


def growth_stages(case: CaseView, *, factor: float, least: float) -> Answer:
    first, end = case["first_separation"], case["time_reached"]
    if not 20 <= first <= end - 20:
        raise Missing(f"case {case.name} does not run for 20 s both before and after its first separation")
    starts = np.arange(5.0, first - 5, 2.5)
    rates = np.array([case.slope("w_point", t, t + 5) for t in starts])
    peak = int(np.argmax(rates))
    slow, sharp = float(rates[starts < first / 2].mean()), float(rates[peak])
    last = case.slope("w_point", first - 3, first)
    return Answer(
        sharp > max(factor * slow, least) and last < sharp,
        f"Growth of the range: {slow:.4f}/s over the first half, {sharp:.3f}/s at {starts[peak] + 2.5:.0f} s, "
        f"{last:.3f}/s just before separation, {case.slope('w_point', end - 20, np.inf):z.4f}/s in the end.",
    )


def fuzz_stays(*pair: CaseView, share: float) -> Answer:
    first = pair[0]["first_separation"]
    spans = (("spectrum_d", first - 4, first), ("spectrum_d", first, first + 4))
    (before, after), (ignored, control) = ([case.signal(*span).filled for span in spans] for case in pair)
    return Answer(
        after >= share * before,
        f"Lines fill {100 * before:.0f} % of 20 to 300 Hz before the first separation and {100 * after:.0f} % after "
        f"it; without separation {100 * ignored:.0f} and {100 * control:.0f} %.",
    )


def no_high_line(case: CaseView, *, share: float, printed: float) -> Answer:
    omega = float(plate_modes(case.parameters)["omega"].max())
    spans = (("spectrum_d", 465, 475), ("spectrum_late", 1490, 1500))
    first, last = (case.signal(*span).power_above(omega / (2 * np.pi)) for span in spans)
    quiet = max(first, last) < share
    right = abs(omega - printed) <= 0.01
    return Answer(
        TRUE if quiet and right else PART if quiet else FALSE,
        f"Power above the highest natural frequency, of that above {LOW:g} Hz: {first:.0e} from 465 to 475 s, "
        f"{last:.0e} from 1490 to 1500 s. That frequency is {omega:.1f} rad/s for this disc; {printed:g} rad/s "
        "belongs to 150 GPa.",
    )


def inplane_contribution(case: CaseView, *, share: float) -> Answer:
    rate = stick_slip_rate(case)
    lines = case.signal(*EARLY).lines(above=LOW, below=HIGH, floor=1e-3)
    made = [line for line in lines if _from_combination(case, line, rate) <= COMBINED]
    theirs, power = (sum(line.amplitude**2 for line in each) for each in (made, lines))
    return Answer(
        theirs / power > share,
        f"{case.place}, 0 to 10 s: {len(made)} of {len(lines)} lines above {LOW:g} Hz, with "
        f"{100 * theirs / power:.0f} % of their power, are n f_s + m f_Ω with f_s = {rate:.2f} Hz.",
    )


def natural_frequencies(case: CaseView) -> measures.Array:
    """Natural frequencies with the slider attached, Hz."""
    return np.asarray(coupled_natural_frequencies(case.parameters) / (2 * np.pi))


def _from_combination(case: CaseView, line: spectra.Line, rate: float) -> float:
    """Distance of a line from the nearest n f_s + m f_Omega, Hz."""
    return abs(spectra.identify(line.frequency, rate, case.drive).deviation)


# ---- The conclusions, as far as the rows on the sections do not judge them


def caused_by_friction(*cases: CaseView, growth: float) -> Answer:
    """Whether some cases separate for which sliding without friction is stable."""
    smooth = [sliding_growth(case.parameters.replace(mu_s=0.0, mu_k=0.0)) for case in cases]
    rows = [f"{case.place}: {case.first_separation()}" for case in cases]
    apart = any(case.separates and rate < growth for case, rate in zip(cases, smooth, strict=True))
    most = f"{max(smooth):.0e}/s" if any(smooth) else "0, that of the undamped in-plane mode"
    return Answer(apart, f"{'; '.join(rows)}. Without friction the largest growth rate is {most}.")


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
    Ambiguous if it rises as that of the mode in which they move with the disc."""
    rows, follows, alone = [], [], []
    for pair in zip(cases[::2], cases[1::2], strict=True):
        rates = [1 / float(case.intervals("separation").mean()) for case in pair]
        modes = [natural_frequencies(case)[0] for case in pair]
        rise, of_mode = rates[1] / rates[0] - 1, modes[1] / modes[0] - 1
        follows.append(rise / of_mode)
        alone.append(rise / (math.sqrt(pair[1]["k"] / pair[0]["k"]) - 1))
        spring = 2 * of_mode / (pair[1]["k"] / pair[0]["k"] - 1)
        rows.append(
            f"{pair[0].place} {rates[0]:.2f} times a second; the mode in which it moves with the disc has "
            f"{modes[0]:.2f} Hz"
        )
    p = cases[0].parameters
    free = float(np.sqrt(p.k / p.m)) / (2 * np.pi)
    level = max(_level(case, free) for case in cases[::2])
    by_mode = all(abs(each - 1) <= within for each in follows)
    return Answer(
        AMBIGUOUS if by_mode else all(abs(each - 1) <= within for each in alone),
        f"Only the vertical branch is judged. The slider leaves the disc at {'. At '.join(rows)}. At sqrt(k/m) = "
        f"{free:.1f} Hz there is no line.",
        f"With k 0.1 % larger the rate rises by {listed(follows, '.3f')} of what that mode's frequency does. The "
        f"spring has {100 * spring:.0f} % of the stiffness of the mode. At {free:.1f} Hz the disc's spectrum has "
        f"{level:.0e} of its strongest line or less.",
        "If the branch is this mode, the sentence is true. If it is the slider on its spring alone, it is false."
        if by_mode
        else "",
    )


def _level(case: CaseView, frequency: float) -> float:
    """Largest amplitude of the disc's point within 1 Hz of a frequency, relative to that of all above 1 Hz."""
    signal = case.signal("late", 0.0, np.inf)
    frequencies, amplitude = spectra.amplitude_spectrum(signal.time, signal.values)
    near, every = (float(amplitude[band].max()) for band in (np.abs(frequencies - frequency) < 1, frequencies > 1))
    return measures.ratio(near, every, f"the spectrum of case {case.name}")
