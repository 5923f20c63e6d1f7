"""Claims of Section 4.4: frequencies of the disc and of the slider, and how they change with time."""

from __future__ import annotations

import numpy as np

from disc_model.analysis import spectra
from disc_model.analysis.classify import Kind
from disc_model.claims import measures
from disc_model.claims.cases import asked, others
from disc_model.claims.measures import many, separates_at
from disc_model.claims.model import CaseView, Claim, Finding, Missing, finding
from disc_model.claims.paper_tables import (
    COMBINED,
    LISTED,
    SEARCHED,
    TABLE_2,
    UNNAMED,
    stick_slip_rate,
    table_2,
    table_2_lines,
)
from disc_model.claims.section41 import quasi_periodic
from disc_model.plate import plate_modes, slider_at_rest_frequencies

EARLY, LATER, LATE = ("spectrum_a", 0.0, 10.0), ("spectrum_b", 38.0, 48.0), ("spectrum_d", 100.0, 110.0)
"""Windows of N = 385 N, 15.1 rad/s, and the stretches of them that are compared, s."""
LOW, HIGH = 20.0, 700.0
"""Hz: above the drive's line and its multiples; above the disc's highest natural frequency."""
FUZZ = "share of 20..300 Hz where the amplitude exceeds 1e-4 of the strongest: little for lines, much for fuzz"


@Claim(
    "T2a",
    "Sec. 4.4, Table 2, Fig. 25a",
    "N = 385 N, Omega = 15.1 rad/s, 0..10 s: the disc's significant frequencies",
    paper=f"{many(LISTED, 1)} Hz",
    tolerance="1 Hz; a line each that noise would have less than once in a thousand times, all nine taken together",
    reason="most are printed to a Hz, read off a plot; 'significant' against the spectrum up to 6 Hz on either side",
    needs=asked(F13=110),
)
def lines(case: CaseView) -> Finding:
    bound = 1.0
    found, table = table_2_lines(case), table_2(case)
    window = measures.stretch(case, *EARLY)
    time, values = window["time"].values, window["w_point"].values
    off = np.abs(table["ours_Hz"] - table["paper_Hz"])
    chance = max(spectra.chance(time, values, line, SEARCHED) for line in found)
    said = ", ".join(f"{row.ours_Hz:.2f} ({row.ours_is})" for row in table.itertuples())
    ours = f"{said} Hz, with f_s = {stick_slip_rate(case):.2f} Hz; each by chance with a probability below "
    ours += f"{max(chance, 1e-99):.0e}"
    floor = min(line.amplitude for line in found) / max(line.amplitude for line in found)
    others = [
        line.frequency
        for line in spectra.lines(time, values, above=1.0, below=300.0, floor=floor, apart=1.0)
        if np.min(np.abs(line.frequency - table["ours_Hz"])) > bound
    ]
    named = int((table["ours_is"] != UNNAMED).sum())
    remark = "" if named == len(found) else f"{named} of {len(found)} are "
    remark += "combinations of the stick-slip rate and the drive's, not natural frequencies: see T2c"
    if others:
        remark += f"; no weaker than the weakest of them, but not in the table: {many(others)} Hz"
    return finding(ours, bool(off.max() <= bound) and chance * len(found) <= 1e-3, remark)


@Claim(
    "T2b",
    "Sec. 4.4",
    "The drive's frequency predominates; its double and triple take part",
    paper="2.4 Hz and multiples",
    tolerance="-60 dB",
    reason="'take part' without a level; the weakest lines of Table 2, f_3 to f_6, are at this level or below",
    needs=asked(F13=110),
)
def drive(case: CaseView) -> Finding:
    drive = case["Omega"] / (2 * np.pi)
    (every,) = measures.loudest(measures.lines(case, *EARLY, above=0.5 * drive), 1)
    window = measures.stretch(case, *EARLY)
    found = [measures.strongest(case, window, n * drive, 0.4 * drive) for n in (1, 2, 3)]
    level = [20 * np.log10(line.amplitude / found[0].amplitude) for line in found]
    ours = ", ".join(f"{line.frequency:.2f} Hz at {x:.0f} dB" for line, x in zip(found, level, strict=True))
    near = all(abs(line.frequency - n * drive) < 0.05 for n, line in zip((1, 2, 3), found, strict=True))
    return finding(ours, near and every.amplitude <= found[0].amplitude * (1 + 1e-9) and min(level) > -60.0)


@Claim(
    "T2c",
    "Sec. 4.4",
    "f_1 to f_6 are natural frequencies of the disc with the slider at rest, shifted by its rotation",
    paper=TABLE_2["f_1"][1],
    tolerance="within 4 f_Omega of a natural frequency, and more than 0.3 Hz from n f_s + m f_Omega",
    reason="a mode of l nodal diameters is seen shifted by l f_Omega; the rate drifts by that within the 10 s, times n",
    needs=asked(F13=110, T2kp18=9.9, T2kp22=9.9, T2Om12=9.9),
)
def follow(*cases: CaseView) -> Finding:
    """Whether the lines move with the disc's frequencies or with the stick-slip rate when that is changed."""
    said, combined, near, worst, farthest = [], [], [], 0.0, 0.0
    for case in cases:
        found = sorted(measures.loudest(measures.lines(case, *EARLY, above=100, below=300, apart=1.0), 6))
        rate = stick_slip_rate(case)
        off = [_from_combination(case, line, rate) for line in found]
        away = [_from_natural(case, line) for line in found]
        combined += [each <= COMBINED for each in off]
        near += [each <= 4 * case["Omega"] / (2 * np.pi) for each in away]
        worst, farthest = max(worst, *off), max(farthest, *away)
        said.append(
            f"k_p = {case['k_p']:g} N/m, Ω = {case['Omega']:g} rad/s (f_s = {rate:.2f} Hz): "
            f"{many([line.frequency for line in found], 1)} Hz"
        )
    remark = (
        f"the six strongest of 100..300 Hz; {sum(combined)} of {len(combined)} are n f_s + m f_Ω to {COMBINED:g} Hz "
        f"when the in-plane spring or the speed is changed (the farthest by {worst:.2f} Hz); {sum(near)} lie near a "
        f"natural frequency, which does not change, others up to {farthest:.0f} Hz away"
    )
    return finding("; ".join(said), all(near) and not any(combined), remark)


@Claim(
    "T2d",
    "Sec. 4.4",
    "f_h1 and f_h2 are the in-plane frequency of 70 Hz, split by the rotation",
    paper="65.5 and 70 Hz",
    tolerance="1 Hz between the middle of the pair and 70 Hz",
    reason="printed to a Hz; the pair is the two strongest lines of 40..100 Hz",
    needs=asked(F13=110),
)
def inplane_line(case: CaseView) -> Finding:
    rate = stick_slip_rate(case)
    drive = case["Omega"] / (2 * np.pi)
    pair = sorted(measures.loudest(measures.lines(case, *EARLY, above=40, below=100, apart=1.0), 2))
    free = float(np.sqrt(case["k_p"] / case["m"])) / (2 * np.pi)
    middle = float(np.mean([line.frequency for line in pair]))
    at = many([line.frequency for line in pair])
    ours = f"ψ at {rate:.2f} Hz; the disc's point at {at} Hz, their middle {middle:.2f} Hz"
    remark = (
        f"they are f_s ± f_Ω ({rate - drive:.2f} and {rate + drive:.2f} Hz), seen in the disc's frame: the rate of "
        f"stick and slip, which sticking makes slower than the spring's own {free:.2f} Hz, and not 70 Hz"
    )
    holds = abs(middle - 70.0) <= 1.0
    return finding(ours, holds, "" if holds else remark)


@Claim(
    "T2e",
    "Sec. 4.4",
    "f_1 to f_6 are close to 135.42, 237.55 and 288.85 Hz",
    paper="close",
    tolerance="5 Hz",
    reason="twice the drive's frequency, which is what rotation can shift a line of the lowest modes by",
    needs=asked(F13=110),
)
def close_to_natural(case: CaseView) -> Finding:
    natural, found = _natural(case), table_2(case)["ours_Hz"].to_numpy()[3:]
    nearest = np.array([natural[np.argmin(np.abs(natural - f))] for f in found])
    off = np.abs(nearest - found)
    said = ", ".join(f"{f:.1f} ({n:.1f})" for f, n in zip(found, nearest, strict=True))
    far = off[off > 5.0]
    remark = f"{far.size} of {off.size} are {far.min():.0f} to {far.max():.0f} Hz away" if far.size else ""
    if 0 < far.size < off.size:
        remark += f"; the others stand at f_Ω on both sides of 2 f_s = {2 * stick_slip_rate(case):.2f} Hz, which nears "
        remark += f"the coupled mode of {natural[0]:.2f} Hz: the resonance at which the quiet cycle ends, see F13b"
    return finding(f"{said} Hz, in brackets the nearest natural frequency", not far.size, remark)


@Claim(
    "F24",
    "Sec. 4.4, Fig. 24",
    "N = 385 N, Omega = 15.1 rad/s: roughly three kinds of behaviour",
    paper="three kinds",
    tolerance="any two of 0..10, 38..48 and 100..110 s differ twofold, in the disc's range or in the band filled",
    reason="what 'kinds' may mean; (c) of the figure begins as (b) and ends as (d)",
    needs=asked(separates=True, F13=110),
)
def three_kinds(case: CaseView) -> Finding:
    spans = (EARLY, LATER, LATE)
    ranges = [float(np.ptp(measures.stretch(case, *span)["w_point"].values)) for span in spans]
    filled = [_fuzziness(case, *span) for span in spans]
    rates = [measures.slope(case, "P", max(start, 1), stop) for _, start, stop in spans]
    ours = "; ".join(
        f"{start:g}..{stop:g} s: disc within {1e3 * width:.1f} mm, lines fill {100 * share:.1f} % of 20..300 Hz, the "
        f"force's range grows by {rate:.4f}/s"
        for (_, start, stop), width, share, rate in zip(spans, ranges, filled, rates, strict=True)
    )
    differ = [
        any(max(x[i], x[j]) >= 2.0 * min(x[i], x[j]) for x in (ranges, filled)) for i, j in ((0, 1), (1, 2), (0, 2))
    ]
    return finding(ours, all(differ))


@Claim(
    "F25b",
    "Sec. 4.4, Fig. 25b",
    "In 38..48 s new frequencies emerge between the main ones",
    paper="new, shifted frequencies",
    tolerance="twice as much of the band filled",
    reason=FUZZ,
    needs=asked(separates=True, F13=110),
)
def new_lines(case: CaseView) -> Finding:
    shares = [_fuzziness(case, *EARLY), _fuzziness(case, *LATER)]
    ours = f"lines fill {100 * shares[0]:.1f} % of 20..300 Hz in 0..10 s, {100 * shares[1]:.1f} % in 38..48 s"
    return finding(ours, shares[1] > 2.0 * shares[0])


@Claim(
    "F25c",
    "Sec. 4.4, Fig. 25c; conclusion 5",
    "With the first separation higher frequencies show up suddenly",
    paper="sudden change",
    tolerance="a factor of 50 in power",
    reason="before, the share is what a smooth motion leaves; 'sudden' is read off a plot of decades",
    needs=asked(separates=True, F13=110),
)
def higher(case: CaseView) -> Finding:
    first = case["first_separation"]
    spans = (("spectrum_c", 50, first), ("spectrum_c", first, 60), LATE)
    before, after, late = (_power_share(case, *span) for span in spans)
    ours = (
        f"power above {HIGH:g} Hz, of that above {LOW:g} Hz: {before:.1e} before, {after:.1e} after, {late:.1e} later"
    )
    return finding(ours, after > 50.0 * before)


@Claim(
    "F25d",
    "Sec. 4.4, Fig. 25d",
    "Long after separation the frequencies are constant and the fuzzy ones gone",
    paper="constant, no fuzz",
    tolerance="half as much of the band filled; lines at rest within 0.01 Hz",
    reason=FUZZ,
    needs=asked(separates=True, F13=110),
)
def steady_lines(case: CaseView) -> Finding:
    fuzz = [_fuzziness(case, *LATER), _fuzziness(case, *LATE)]
    first, second = (
        measures.lines(case, "spectrum_d", *span, above=LOW, floor=1e-2) for span in ((100, 105), (105, 110))
    )
    drift = max(min(abs(a.frequency - b.frequency) for b in second) for a in first)
    ours = (
        f"lines fill {100 * fuzz[1]:.1f} % of 20..300 Hz ({100 * fuzz[0]:.1f} % in 38..48 s); from 100..105 to "
        f"105..110 s they move by {drift:.0e} Hz at most"
    )
    return finding(ours, fuzz[1] < fuzz[0] / 2.0 and drift < 0.01)


@Claim(
    "F26",
    "Sec. 4.4, Fig. 26",
    "The slider's irregular frequencies disappear after separation: stick-slip becomes periodic",
    paper="periodic",
    tolerance="half as much of the band filled; release intervals repeat to 1e-8 s",
    reason=FUZZ,
    needs=asked(separates=True, steady=True, F13=110),
)
def slider_settles(case: CaseView) -> Finding:
    first = case["first_separation"]
    spans = (("spectrum_c", 50, first), ("spectrum_d", 100, 100 + first - 50))
    before, after = (_fuzziness(case, *span, name="psi") for span in spans)
    motion, said = measures.late_motion(case)
    ours = f"lines of ψ fill {100 * before:.1f} % of 20..300 Hz before, {100 * after:.1f} % after; then {said}"
    return finding(ours, after < before / 2.0 and motion.period > 0)


@Claim(
    "F26b",
    "Sec. 4.4, Fig. 26b",
    "After separation the lines of ψ are the slider's frequency f_h and its multiples",
    paper="n f_h",
    tolerance="0.2 Hz, for all lines above a hundredth of the strongest, from separation to 60 s and in 100..110 s",
    reason="a quarter of what the first stretch resolves",
    needs=asked(separates=True, steady=True, F13=110),
)
def multiples(case: CaseView) -> Finding:
    bound = 0.2
    first = case["first_separation"]
    late = _lines_of_psi(case, *LATE)
    rate = late[0].frequency
    before = _off_multiples(_lines_of_psi(case, "spectrum_c", 50, first), rate)
    after = _off_multiples([*_lines_of_psi(case, "spectrum_c", first, 60), *late], rate)
    ours = (
        f"f_h = {rate:.2f} Hz; of {len(after)} lines the farthest from n f_h is {max(after):.2f} Hz off; before, "
        f"{sum(off > bound for off in before)} of {len(before)} lines are no n f_h"
    )
    releases = measures.rate_of(case, "stick_to_slip") / rate
    remark = f"f_h is the rate at which stick and slip repeat, {releases:.2g} releases each time, not 70 Hz: see T2d"
    return finding(ours, max(after) <= bound, remark)


@Claim(
    "F27",
    "Sec. 4.4, Fig. 27",
    "N = 300 N, Omega = 20 rad/s: first separation",
    paper="149.5 s",
    tolerance="0.2 s",
    reason="'around' in the text, and slow growth: 1e-7 m in the start moves it by 0.02 s",
    needs=asked(F07=150),
)
def when_it_separates(case: CaseView) -> Finding:
    return separates_at(case, 149.5, 0.2)


@Claim(
    "F27a",
    "Sec. 4.4, Fig. 27a",
    "The vibration grows gradually, then sharply, then less, and is bounded after separation",
    paper="slow, sharp, slower, bounded",
    tolerance="sharp: 3 times the mean rate of the first half",
    reason="what 'sharply' may mean",
    needs=asked(separates=True, F07=190),
)
def growth_stages(case: CaseView) -> Finding:
    first, end = case["first_separation"], case["time_reached"]
    if not 20 <= first <= end - 20:
        raise Missing(f"case {case.name} does not run for 20 s both before and after its first separation")
    starts = np.arange(5.0, first - 5, 2.5)
    rates = np.array([measures.slope(case, "w_point", t, t + 5) for t in starts])
    peak = int(np.argmax(rates))
    slow, sharp = float(rates[starts < first / 2].mean()), float(rates[peak])
    last, after = measures.slope(case, "w_point", first - 3, first), measures.slope(case, "w_point", end - 20, end)
    ours = (
        f"growth of the range: {slow:.4f}/s over the first half, {sharp:.3f}/s at {starts[peak] + 2.5:.0f} s, "
        f"{last:.3f}/s just before separation, {after:.4f}/s in the end"
    )
    grows = sharp > max(3.0 * slow, 2e-3)  # at least 1 % in the 5 s that it is measured over
    return finding(ours, grows and last < sharp and abs(after) < 0.01 * sharp)


@Claim(
    "F27b",
    "Sec. 4.4, Fig. 27b",
    "143..153 s: the disc's vibration is mainly governed by its natural frequencies",
    paper="natural frequencies",
    tolerance="90 % of the power of the four strongest lines, the drive's counted",
    reason="the criterion of T2c for each line, all lines from half the drive's on as in T2b; what 'mainly' may mean",
    needs=asked(separates=True, F07=190),
)
def natural_lines(case: CaseView) -> Finding:
    bound = 0.9
    span = ("spectrum_d", 143.0, 153.0)
    drive, rate = case["Omega"] / (2 * np.pi), stick_slip_rate(case, *span)
    every, higher = (
        measures.loudest(measures.lines(case, *span, above=above, floor=1e-3), 4) for above in (0.5 * drive, LOW)
    )
    share, without = (_natural_share(case, found, rate) for found in (every, higher))
    ours = f"strongest lines {many([line.frequency for line in every], 1)} Hz: {100 * share:.0f} % of their power "
    ours += f"within 4 f_Ω of a natural frequency, the lowest being {_natural(case)[0]:.1f} Hz, and no n f_s + m f_Ω "
    ours += f"(f_s = {rate:.2f} Hz)"
    remark = "that is the lowest coupled mode, l f_Ω up and down in the disc's frame; the others hardly take part"
    if share <= bound < without:
        remark = f"above {LOW:g} Hz, without the drive's line, {100 * without:.0f} %: {remark}"
    return finding(ours, share > bound, remark if without > bound else "")


@Claim(
    "F27c",
    "Sec. 4.4, Fig. 27b; conclusion 5",
    "After separation higher frequencies arise, and the fuzzy ones stay",
    paper="both",
    tolerance="not less than two thirds as much of the band filled; power above 700 Hz ten times",
    reason=FUZZ,
    needs=asked(separates=True, F07=190),
)
def fuzz_stays(case: CaseView) -> Finding:
    first = case["first_separation"]
    spans = (("spectrum_d", first - 4, first), ("spectrum_d", first, first + 4))
    before, after = (_fuzziness(case, *span) for span in spans)
    high_before, high_after = (_power_share(case, *span) for span in spans)
    ours = (
        f"lines fill {100 * before:.0f} % of 20..300 Hz before and {100 * after:.0f} % after; "
        f"power above {HIGH:g} Hz {high_before:.1e} before, {high_after:.1e} after"
    )
    return finding(ours, after > before / 1.5 and high_after > 10 * high_before)


steady_state_is_quasi_periodic = quasi_periodic(
    "F28",
    "Sec. 4.4, Fig. 28b",
    "The same case: stick-slip is quasi-periodic in the steady state",
    needs=asked(separates=True, steady=True, F07=190) | others("F07"),
)


@Claim(
    "F29",
    "Sec. 4.4, Fig. 29b",
    "E = 100 GPa: no frequency above the highest natural one",
    paper="none above 4383.04 rad/s",
    tolerance="1e-7 of the power above 20 Hz",
    reason="70 dB below the vibration is below what the figure shows",
    needs=asked(F21=1500),
)
def no_high_line(case: CaseView) -> Finding:
    omega = float(plate_modes(case.parameters)["omega"].max())
    base = float(plate_modes(case.parameters.replace(E=150e9))["omega"].max())
    spans = (("spectrum_d", 465, 475), ("spectrum_late", 1490, 1500))
    shares = [_power_share(case, *span, omega / (2 * np.pi)) for span in spans]
    ours = f"share of power above {omega:.1f} rad/s, of that above {LOW:g} Hz: {shares[0]:.0e} in 465..475 s, "
    ours += f"{shares[1]:.0e} in 1490..1500 s"
    remark = f"at 100 GPa the highest natural frequency is {omega:.1f} rad/s; {base:.2f} rad/s belongs to 150 GPa"
    return finding(ours, max(shares) < 1e-7, remark)


@Claim(
    "F29b",
    "Sec. 4.4, Fig. 29b",
    "E = 100 GPa: erratic vibration with several incommensurate frequencies",
    paper="several",
    tolerance="at least 2 independent frequencies besides the stick-slip rate and the drive's, a tenth of the "
    "strongest line or more; irregular",
    reason="'several': with one besides, motions that do not wander have as many lines; lines are known to 0.1 Hz",
    needs=asked(F21=480),
)
def erratic(case: CaseView) -> Finding:
    rate = stick_slip_rate(case, "spectrum_d", 465, 475)
    found = measures.lines(case, "spectrum_d", 465, 475, above=LOW, below=600, floor=1e-2)
    strongest = max(line.amplitude for line in found)
    every = _further(found, rate, case["Omega"] / (2 * np.pi))
    further = [line for line in every if line.amplitude >= 0.1 * strongest]
    seen = ", ".join(f"{line.frequency:.2f} Hz ({line.amplitude / strongest:.2g})" for line in further)
    motion, said = measures.late_motion(case)
    ours = (
        f"{len(found)} lines above a hundredth of the strongest, made of f_s = {rate:.2f} Hz, f_Ω and {len(further)} "
        f"independent frequencies, seen at {seen or 'none'}, and {len(every) - len(further)} weak ones; "
        f"in-plane motion {said}"
    )
    several = len(further) >= 2
    second = further[1].amplitude / further[0].amplitude if several else 1.0
    remark = f"mainly one of them: the next is {second:.2g} times as strong" if second < 0.5 else ""
    return measures.of_kind(Kind.IRREGULAR, motion, ours, besides=several, remark=remark)


def _lines_of_psi(case: CaseView, window: str, start: float, stop: float) -> list[spectra.Line]:
    """Lines of psi above a hundredth of the strongest, by ascending frequency."""
    return measures.lines(case, window, start, stop, "psi", above=LOW, below=HIGH, floor=1e-2)


def _off_multiples(lines: list[spectra.Line], rate: float) -> list[float]:
    """How far each line is from the nearest multiple of a rate, Hz."""
    return [abs(line.frequency - max(round(line.frequency / rate), 1) * rate) for line in lines]


def _natural(case: CaseView) -> np.ndarray:
    """Natural frequencies with the slider attached, Hz."""
    return slider_at_rest_frequencies(case.parameters) / (2 * np.pi)


def _from_combination(case: CaseView, line: spectra.Line, rate: float) -> float:
    """How far a line is from the nearest n f_s + m f_Omega, Hz."""
    return abs(spectra.identify(line.frequency, rate, case["Omega"] / (2 * np.pi)).deviation)


def _from_natural(case: CaseView, line: spectra.Line) -> float:
    """How far a line is from the nearest natural frequency with the slider attached, Hz."""
    return float(np.min(np.abs(_natural(case) - line.frequency)))


def _natural_share(case: CaseView, lines: list[spectra.Line], rate: float) -> float:
    """Share of the power of lines in those near a natural frequency that are no n f_s + m f_Omega."""
    within = 4 * case["Omega"] / (2 * np.pi)
    near = [
        line for line in lines if _from_natural(case, line) <= within and _from_combination(case, line, rate) > COMBINED
    ]
    return sum(line.amplitude**2 for line in near) / sum(line.amplitude**2 for line in lines)


def _further(lines: list[spectra.Line], rate: float, drive: float) -> list[spectra.Line]:
    """Lines, the strongest first, that are not made of f_s, f_Omega and those before: each a further frequency.

    A line is made of them if it is p f + n f_s + m f_Omega to 0.1 Hz, with one f of those before and abs(p) <= 2.
    """
    sums = np.add.outer(rate * np.arange(-12, 13), drive * np.arange(-3, 4)).ravel()
    further: list[spectra.Line] = []
    known = sums
    for line in measures.loudest(lines, len(lines)):
        if np.min(np.abs(known - line.frequency)) > 0.1:
            further.append(line)
            known = np.concatenate([known, *(sums + p * line.frequency for p in (-2, -1, 1, 2))])
    return further


def _fuzziness(case: CaseView, window: str, start: float, stop: float, name: str = "w_point") -> float:
    """Share of 20..300 Hz where a variable's amplitude exceeds 1e-4 of the strongest there.

    Only stretches of equal length, which resolve equally, can be compared.
    """
    part = measures.stretch(case, window, start, stop)
    return spectra.coverage(part["time"].values, part[name].values, LOW, 300.0, floor=1e-4)


def _power_share(case: CaseView, window: str, start: float, stop: float, above: float = HIGH) -> float:
    """Share of the power above a frequency in Hz in that above `LOW`."""
    measures.lines(case, window, start, stop, above=LOW)  # without any there is no power to share
    part = measures.stretch(case, window, start, stop)
    return spectra.power_share(part["time"].values, part["w_point"].values, above, LOW)
