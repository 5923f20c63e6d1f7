"""Claims of Section 4.4: frequencies of the disc and of the slider, and how they change with time."""

import math
from itertools import combinations
from typing import Any

import numpy as np

from disc_model.analysis import spectra
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome
from disc_model.disc.plate import coupled_natural_frequencies, plate_modes
from disc_model.paper import measures
from disc_model.paper.measures import HIGH, LOW, CaseView, is_kind
from disc_model.paper.model import Answer
from disc_model.paper.paper_tables import COMBINED, SEARCHED, UNNAMED, stick_slip_rate, table_2, table_2_lines

EARLY, LATER, LATE = ("spectrum_a", 0.0, 10.0), ("spectrum_b", 38.0, 48.0), ("spectrum_d", 100.0, 110.0)
"""Windows of N = 385 N, 15.1 rad/s, and their stretches that are compared, s."""
STILL = 3e-4
"""Greatest growth rate of a motion that counts as steady, 1/s, see `disc_model.paper.measures.STRETCH`."""


def lines(case: CaseView, *, bound: float) -> Answer:
    found, table, signal = table_2_lines(case), table_2(case), case.signal(*EARLY)
    off = np.abs(table["ours_Hz"] - table["paper_Hz"])
    chance = max(spectra.chance(signal.time, signal.values, line, SEARCHED) for line in found)
    floor = min(line.amplitude for line in found) / max(line.amplitude for line in found)
    others = [
        line.frequency
        for line in signal.lines(above=1.0, below=300.0, floor=floor, apart=1.0)
        if np.min(np.abs(line.frequency - table["ours_Hz"])) > bound
    ]
    named = int((table["ours_is"] != UNNAMED).sum())
    return Answer(
        off.max() <= bound and chance * len(found) <= 1e-3,
        lines=[f"{row.ours_Hz:.2f} ({row.ours_is})" for row in table.itertuples()],
        rate=stick_slip_rate(case),
        chance=max(chance, 1e-99),
        named=named,
        count=len(found),
        others=others,
    )


def drive(case: CaseView, *, level: float) -> Answer:
    signal, orders = case.signal(*EARLY), (1, 2, 3)
    (every,) = measures.loudest(signal.lines(above=0.5 * case.drive), 1)
    found = [signal.strongest(n * case.drive, 0.4 * case.drive) for n in orders]
    near = all(abs(line.frequency - n * case.drive) < 0.05 for n, line in zip(orders, found, strict=True))
    strongest = every.amplitude <= found[0].amplitude * (1 + 1e-9)
    loud = min(line.amplitude for line in found) > level * found[0].amplitude
    levels = [20 * np.log10(line.amplitude / found[0].amplitude) for line in found]
    texts = [f"{line.frequency:.2f} Hz at {level:.0f} dB" for line, level in zip(found, levels, strict=True)]
    return Answer(near and strongest and loud, lines=texts)


def follow(*cases: CaseView, within: float) -> Answer:
    """Whether the lines move with the disc's frequencies or with the stick-slip rate when that is changed."""
    rows, off, away, near = [], [], [], []
    for case in cases:
        found = sorted(measures.loudest(case.signal(*EARLY).lines(above=100, below=300, apart=1.0), 6))
        rate = stick_slip_rate(case)
        off += [_from_combination(case, line, rate) for line in found]
        away += [_from_natural(case, line) for line in found]
        near += [_from_natural(case, line) <= 4 * case.drive for line in found]
        rows.append({"case": case, "rate": rate, "lines": [line.frequency for line in found]})
    combined = [each <= within for each in off]
    return Answer(
        all(near) and not any(combined),
        tried=rows,
        combined=sum(combined),
        count=len(combined),
        worst=max(off),
        near=sum(near),
        farthest=max(away),
    )


def inplane_pair(case: CaseView, *, within: float) -> Answer:
    rate = stick_slip_rate(case)
    found = measures.loudest(case.signal(*EARLY).lines(above=40, below=100, apart=1.0), 2)
    pair, split = sorted(line.frequency for line in found), [rate - case.drive, rate + case.drive]
    return Answer(len(pair) == 2 and np.allclose(pair, split, atol=within, rtol=0), rate=rate, pair=pair, split=split)


def inplane_frequency(case: CaseView, *, printed: float, within: float) -> Answer:
    rate, free = stick_slip_rate(case), float(np.sqrt(case["k_p"] / case["m"])) / (2 * np.pi)
    holds = abs(rate - printed) <= within
    return Answer(holds, rate=rate, free=free, slower=not holds)


def close_to_natural(case: CaseView, *, within: float) -> Answer:
    natural, found = _natural(case), table_2(case)["ours_Hz"].to_numpy()[3:]
    nearest = np.array([natural[np.argmin(np.abs(natural - f))] for f in found])
    off = np.abs(nearest - found)
    far = off[off > within]
    return Answer(
        not far.size,
        lines=[f"{f:.1f} ({n:.1f})" for f, n in zip(found, nearest, strict=True)],
        far=far.size,
        count=off.size,
        least=far.min(initial=np.inf),
        most=far.max(initial=0.0),
        others=0 < far.size < off.size,
        double=2 * stick_slip_rate(case),
        lowest=natural[0],
    )


def vertical_branch(*cases: CaseView, within: float) -> Answer:
    """Whether the rate of separations rises with a stiffer spring as the frequency of slider and spring alone does.

    Undecided if it rises as that of the mode in which they move with the disc.
    """
    found, alone = [], []
    for pair in zip(cases[::2], cases[1::2], strict=True):
        rates = [1 / float(case.intervals("separation").mean()) for case in pair]
        modes = [_natural(case)[0] for case in pair]
        rise, of_mode = rates[1] / rates[0] - 1, modes[1] / modes[0] - 1
        found.append({"case": pair[0], "rate": rates[0], "mode": modes[0], "follows": rise / of_mode})
        spring = 2 * of_mode / (pair[1]["k"] / pair[0]["k"] - 1)
        alone.append(rise / (math.sqrt(pair[1]["k"] / pair[0]["k"]) - 1))
    p = cases[0].parameters
    free = float(np.sqrt(p.k / p.m)) / (2 * np.pi)
    holds = all(abs(follows - 1) <= within for follows in alone)
    return Answer(
        None if all(abs(row["follows"] - 1) <= within for row in found) else holds,
        "branch",
        pairs=found,
        without=free,
        level=max(_level(case, free) for case in cases[::2]),
        spring=spring,
    )


def _level(case: CaseView, frequency: float) -> float:
    """Largest amplitude of the disc's point within 1 Hz of a frequency, relative to that of all above 1 Hz."""
    signal = case.signal("late", 0.0, np.inf)
    found, amplitude = spectra.amplitude_spectrum(signal.time, signal.values)
    near, every = (float(amplitude[at].max()) for at in (np.abs(found - frequency) < 1, found > 1))
    return measures.ratio(near, every, f"the spectrum of case {case.name}")


def inplane_contribution(case: CaseView, *, share: float) -> Answer:
    rate = stick_slip_rate(case)
    found = case.signal(*EARLY).lines(above=LOW, below=HIGH, floor=1e-3)
    made = [line for line in found if _from_combination(case, line, rate) <= COMBINED]
    theirs, power = (sum(line.amplitude**2 for line in each) for each in (made, found))
    return Answer(theirs / power > share, part=theirs / power, made=len(made), count=len(found), rate=rate)


def three_kinds(case: CaseView, *, factor: float) -> Answer:
    spans = [case.signal(*span) for span in (EARLY, LATER, LATE)]
    rates = [case.slope("P", max(span.start, 1), span.stop) for span in spans]
    rows = [{"span": span, "rate": rate} for span, rate in zip(spans, rates, strict=True)]
    kinds = [(span.width, span.filled, max(rate, STILL)) for span, rate in zip(spans, rates, strict=True)]
    differ = [any(max(pair) >= factor * min(pair) for pair in zip(*two, strict=True)) for two in combinations(kinds, 2)]
    return Answer(all(differ), spans=rows)


def new_lines(case: CaseView, *, factor: float, floor: float) -> Answer:
    """Whether lines appear that, unlike all main ones, do not combine the stick-slip frequency and the drive's."""
    rate = stick_slip_rate(case)
    found = [case.signal(*span).lines(above=LOW, below=300.0, floor=floor) for span in (EARLY, LATER)]
    early, later = (sum(_from_combination(case, line, rate) > COMBINED for line in each) for each in found)
    return Answer(later > factor * max(early, 1), early=early, later=later)


def higher(case: CaseView, bonded: CaseView, *, factor: float, floor: float) -> Answer:
    first = case["first_separation"]
    spans = (("spectrum_c", 50, first), ("spectrum_c", first, 60), LATE)
    (before, after, late), ignored = ([each.signal(*span).high for span in spans] for each in (case, bonded))
    here, there = (b > max(factor * a, floor) for a, b in ((before, after), ignored[:2]))
    return Answer(*_beside(here, there), before=before, after=after, late=late, ignored=ignored)


def _beside(here: bool, there: bool) -> tuple[bool | None, str]:
    """Whether something changes with separation; undecided if it changes without separation as well."""
    return None if here and there else here, "control"


def steady_lines(*pair: CaseView, part: float, within: float) -> Answer:
    rows, found = [], []
    for case in pair:
        before, after = (case.signal(*span).filled for span in (LATER, LATE))
        first, second = (
            case.signal("spectrum_d", *span).lines(above=LOW, floor=1e-2) for span in ((100, 105), (105, 110))
        )
        drift = max(min(abs(a.frequency - b.frequency) for b in second) for a in first)
        found.append(after < part * before and drift < within)
        rows.append({"case": case, "before": before, "after": after, "drift": drift})
    return Answer(*_beside(*found), stretches=rows)


def slider_settles(*pair: CaseView, part: float) -> Answer:
    first = pair[0]["first_separation"]
    length, begins = first - 50, (("spectrum_c", 50.0), ("spectrum_c", first), ("spectrum_d", 100.0))
    filled = [[case.signal(window, at, at + length, "psi").filled for window, at in begins] for case in pair]
    rows = [{"case": case, "before": each[0], "after": each[1]} for case, each in zip(pair, filled, strict=True)]
    (before, after, _), (ignored, control, late) = filled
    found = _beside(after < part * before, control < part * ignored)
    return Answer(*found, stretches=rows, later=late < part * ignored and late)


def multiples(case: CaseView, *, bound: float) -> Answer:
    first = case["first_separation"]
    late, before, after = (
        case.signal(*span).lines(above=LOW, below=HIGH, floor=1e-2)
        for span in ((*LATE, "psi"), ("spectrum_c", 50.0, first, "psi"), ("spectrum_c", first, 60.0, "psi"))
    )
    rate = late[0].frequency
    off, early = (
        [abs(line.frequency - max(round(line.frequency / rate), 1) * rate) for line in lines]
        for lines in ([*after, *late], before)
    )
    return Answer(
        max(off) <= bound,
        rate=rate,
        count=len(off),
        worst=max(off),
        others=sum(each > bound for each in early),
        before=len(early),
        releases=case.rate_of("stick_to_slip") / rate,
    )


def growth_stages(case: CaseView, bonded: CaseView, *, factor: float, least: float, rest: float) -> Answer:
    first, end = case["first_separation"], case["time_reached"]
    if not 20 <= first <= end - 20:
        raise Missing(f"case {case.name} does not run for 20 s both before and after its first separation")
    starts = np.arange(5.0, first - 5, 2.5)
    rates = np.array([case.slope("w_point", t, t + 5) for t in starts])
    peak = int(np.argmax(rates))
    slow, sharp = float(rates[starts < first / 2].mean()), float(rates[peak])
    last = case.slope("w_point", first - 3, first)
    after, ignored = (each.slope("w_point", each["time_reached"] - 20, np.inf) for each in (case, bonded))
    here, there = (abs(rate) < rest * sharp for rate in (after, ignored))
    stages = sharp > max(factor * slow, least) and last < sharp
    numbers = {"slow": slow, "sharp": sharp, "at": starts[peak] + 2.5, "last": last, "after": after}
    return Answer(*_beside(stages and here, stages and there), **numbers)


def natural_lines(case: CaseView, *, share: float, near: float) -> Answer:
    span = ("spectrum_d", 143.0, 153.0)
    signal, rate = case.signal(*span), stick_slip_rate(case, *span)
    found, every = (measures.loudest(signal.lines(above=above, floor=1e-3), 4) for above in (LOW, 0.5 * case.drive))
    ours, counted = (_natural_share(case, lines, rate, near) for lines in (found, every))
    holds = None if counted <= share < ours else ours > share
    lines, lowest = [line.frequency for line in found], _natural(case)[0]
    return Answer(holds, "drive", lines=lines, ours=ours, lowest=lowest, rate=rate, counted=counted)


def fuzz_stays(*pair: CaseView, part: float, factor: float, floor: float) -> Answer:
    first = pair[0]["first_separation"]
    spans = (("spectrum_d", first - 4, first), ("spectrum_d", first, first + 4))
    rows, found = [], []
    for case in pair:
        before, after = (case.signal(*span) for span in spans)
        stays, rises = after.filled > before.filled / part, after.high > max(factor * before.high, floor)
        found.append(stays and rises)
        rows.append({"case": case, "before": before, "after": after})
    return Answer(*_beside(*found), stretches=rows)


def no_high_line(case: CaseView, *, share: float) -> Answer:
    p = case.parameters
    omega, base = (float(plate_modes(each)["omega"].max()) for each in (p, p.replace(E=150e9)))
    spans = (("spectrum_d", 465, 475), ("spectrum_late", 1490, 1500))
    first, last = (case.signal(*span).power_above(omega / (2 * np.pi)) for span in spans)
    return Answer(max(first, last) < share, omega=omega, first=first, last=last, base=base)


def lines_shift(case: CaseView, *, part: float, floor: float, apart: float) -> Answer:
    """Whether weak lines of one stretch are missing in the next."""
    first, second = (
        case.signal("spectrum_d", *span).lines(above=LOW, below=600, floor=floor) for span in ((465, 470), (470, 475))
    )
    weak = [line for line in first if line.amplitude < 0.1 * max(each.amplitude for each in first)]
    moved = [line for line in weak if min(abs(line.frequency - other.frequency) for other in second) > apart]
    return Answer(len(moved) > part * len(weak), moved=len(moved), count=len(weak))


def erratic(case: CaseView, *, several: float, part: float, apart: float) -> Answer:
    """Whether the spectrum is erratic; undecided if the number of frequencies depends on the resolution of lines."""
    rate = stick_slip_rate(case, "spectrum_d", 465, 475)
    found = case.signal("spectrum_d", 465, 475).lines(above=LOW, below=600, floor=1e-2)
    strongest = max(line.amplitude for line in found)
    every, coarse = (_further(found, rate, case.drive, width) for width in (apart, 2 * apart))
    further, fewer = ([line for line in lines if line.amplitude >= part * strongest] for lines in (every, coarse))
    second = further[1].amplitude / further[0].amplitude if len(further) > 1 else 1.0
    holds, why = is_kind(Outcome.IRREGULAR, case.late_motion(), len(further) >= several)
    depends = holds and len(fewer) < several
    return Answer(
        None if depends else holds,
        "width" if depends else why,
        fewer=len(fewer),
        double=2 * apart,
        count=len(found),
        rate=rate,
        further=len(further),
        seen=[f"{line.frequency:.2f} Hz ({line.amplitude / strongest:.2g})" for line in further],
        weak=len(every) - len(further),
        mainly=second < 0.5,
        second=second,
    )


def _natural(case: CaseView) -> Any:
    """Natural frequencies with the slider attached, Hz."""
    return coupled_natural_frequencies(case.parameters) / (2 * np.pi)


def _from_combination(case: CaseView, line: spectra.Line, rate: float) -> float:
    """Distance of a line from the nearest n f_s + m f_Omega, Hz."""
    return abs(spectra.identify(line.frequency, rate, case.drive).deviation)


def _from_natural(case: CaseView, line: spectra.Line) -> float:
    """Distance of a line from the nearest natural frequency with the slider attached, Hz."""
    return float(np.min(np.abs(_natural(case) - line.frequency)))


def _natural_share(case: CaseView, lines: list[spectra.Line], rate: float, near: float) -> float:
    """Fraction of the lines' power in lines beside a natural frequency that are not near any n f_s + m f_Omega."""
    within = 4 * case.drive
    own = [line for line in lines if _from_natural(case, line) <= within and _from_combination(case, line, rate) > near]
    return sum(line.amplitude**2 for line in own) / sum(line.amplitude**2 for line in lines)


def _further(lines: list[spectra.Line], rate: float, drive: float, apart: float) -> list[spectra.Line]:
    """Further frequencies: lines, the strongest first, not made of f_s, f_Omega and the lines before them.

    A line is made of them if it is p f + n f_s + m f_Omega to ``apart`` Hz, for one earlier f and abs(p) <= 2.
    """
    sums = np.add.outer(rate * np.arange(-12, 13), drive * np.arange(-3, 4)).ravel()
    further: list[spectra.Line] = []
    known = sums
    for line in measures.loudest(lines, len(lines)):
        if np.min(np.abs(known - line.frequency)) > apart:
            further.append(line)
            known = np.concatenate([known, *(sums + p * line.frequency for p in (-2, -1, 1, 2))])
    return further
