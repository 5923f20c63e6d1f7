"""Rows on Section 4.4: frequencies of the disc and of the slider, and how they change with time."""

import numpy as np

from disc_model.analysis import spectra
from disc_model.data.dataset import Missing
from disc_model.disc.plate import coupled_natural_frequencies, plate_modes
from disc_model.paper import measures
from disc_model.paper.measures import HIGH, LOW, CaseView, listed
from disc_model.paper.model import FALSE, PART, TRUE, Answer, graded
from disc_model.paper.paper_tables import COMBINED, SEARCHED, UNNAMED, stick_slip_rate, table_2, table_2_lines
from disc_model.paper.section2 import attached_frequencies
from disc_model.paper.section43 import soft_disc

__all__ = ["attached_frequencies", "soft_disc"]  # which the texts name as well
EARLY, LATER, LATE = ("spectrum_a", 0.0, 10.0), ("spectrum_b", 38.0, 48.0), ("spectrum_d", 100.0, 110.0)
"""Windows of N = 385 N, 15.1 rad/s, and their stretches that are compared, s."""


def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    return Answer(
        abs(case["first_separation"] - printed) <= within,
        f"{case.first_separation().capitalize()}. The paper has {printed:g} s.",
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
    drift, bonded_drift = _drift(case), _drift(bonded)
    text = (
        f"From 100 to 110 s lines move by {drift:.0e} Hz at most with separation, and by {bonded_drift:.0e} Hz without."
    )
    return Answer(FALSE if drift > within else PART if bonded_drift <= within else TRUE, text)


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
        away += [_from_natural(case, line) / case.drive for line in lines]
        found_text = ", ".join(f"{line.frequency:.1f}" for line in lines)
        rows.append(
            f"k_p = {1e-3 * case['k_p']:g} kN/m, Ω = {case['Omega']:g} rad/s, f_s = {rate:.2f} Hz: {found_text} Hz"
        )
    combined = [each <= within for each in off]
    return Answer(
        max(away) <= 4 and not any(combined),
        f"The lines follow the stick-slip rate: {sum(combined)} of {len(combined)} are n f_s + m f_Ω, to "
        f"{max(off):.2f} Hz, when the in-plane spring or the speed is changed. Natural frequencies do not change, and "
        f"are up to {max(away) * cases[0].drive:.0f} Hz away.",
        f"{'; '.join(rows)}.",
    )


def inplane_frequency(case: CaseView, *, printed: float, within: float) -> Answer:
    rate, free = stick_slip_rate(case), float(np.sqrt(case["k_p"] / case["m"])) / (2 * np.pi)
    slower = f"It is the rate of stick and slip. Sticking makes it slower than the spring's own {free:.2f} Hz."
    holds = abs(rate - printed) <= within
    return Answer(holds, f"The slider vibrates at {rate:.2f} Hz.", "" if holds else slower)


def close_to_natural(case: CaseView, *, within: float) -> Answer:
    natural, computed = natural_frequencies(case), table_2(case)["ours_Hz"].to_numpy()[3:]
    nearest = np.array([natural[np.argmin(np.abs(natural - f))] for f in computed])
    far = np.abs(nearest - computed) > within
    rows = ", ".join(f"{f:.1f} ({n:.1f})" for f, n in zip(computed, nearest, strict=True))
    return Answer(
        graded(~far) if not far.any() else FALSE,
        f"{rows} Hz, in brackets the nearest natural frequency: {far.sum()} of {far.size} are more than {within:g} Hz "
        "away.",
        f"Twice the stick-slip rate is {2 * stick_slip_rate(case):.2f} Hz, near the coupled mode at {natural[0]:.2f} "
        "Hz."
        if 0 < far.sum() < far.size
        else "",
    )


def higher(
    case: CaseView, bonded: CaseView, *, factor: float, floor: float, window: str, low: float, high: float
) -> Answer:
    """Whether power above the natural frequencies rises with the first separation, and not without separation.

    low, high : s, where what is compared begins before it and ends after it
    """
    first = case["first_separation"]
    spans = ((low, first), (first, high))
    (before, after), (ignored, control) = (
        [each.signal(window, *span).high for span in spans] for each in (case, bonded)
    )
    grows, grows_in_control = after > max(factor * before, floor), control > max(factor * ignored, floor)
    return Answer(
        TRUE if grows and not grows_in_control else PART if grows else FALSE,
        f"Power above {HIGH:g} Hz, of that above {LOW:g} Hz: {before:.1e} before, {after:.1e} after; without "
        f"separation {control:.1e} then.",
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


def _from_natural(case: CaseView, line: spectra.Line) -> float:
    """Distance of a line from the nearest natural frequency with the slider attached, Hz."""
    return float(np.min(np.abs(natural_frequencies(case) - line.frequency)))
