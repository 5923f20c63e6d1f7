"""Claims of Section 4.4: frequencies of the disc and of the slider, and how they change with time."""

import math
from itertools import combinations
from typing import Any

import numpy as np

from disc_model.analysis import spectra
from disc_model.claims import measures
from disc_model.claims.measures import CaseView, is_kind
from disc_model.claims.model import Answer
from disc_model.claims.paper_tables import COMBINED, SEARCHED, UNNAMED, stick_slip_rate, table_2, table_2_lines
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome
from disc_model.plate import coupled_natural_frequencies, plate_modes

EARLY, LATER, LATE = ("spectrum_a", 0.0, 10.0), ("spectrum_b", 38.0, 48.0), ("spectrum_d", 100.0, 110.0)
"""Windows of N = 385 N, 15.1 rad/s, and their stretches that are compared, s."""
LOW, HIGH = 20.0, 700.0
"""Hz: above the drive's line and its multiples; above the disc's highest natural frequency."""
STILL = 3e-4
"""Greatest growth rate of a motion that counts as steady, 1/s, see `disc_model.claims.measures.STRETCH`."""


def lines(case: CaseView, *, bound: float) -> Answer:
    found, table = table_2_lines(case), table_2(case)
    window = case.signal(*EARLY)
    off = np.abs(table["ours_Hz"] - table["paper_Hz"])
    chance = max(spectra.chance(*window, line, SEARCHED) for line in found)
    floor = min(line.amplitude for line in found) / max(line.amplitude for line in found)
    others = [
        line.frequency
        for line in spectra.lines(*window, above=1.0, below=300.0, floor=floor, apart=1.0)
        if np.min(np.abs(line.frequency - table["ours_Hz"])) > bound
    ]
    named = int((table["ours_is"] != UNNAMED).sum())
    return Answer(
        off.max() <= bound and chance * len(found) <= 1e-3,
        lines=[f"{row.ours_Hz:.2f} ({row.ours_is})" for row in table.itertuples()],
        rate=stick_slip_rate(case),
        chance=max(chance, 1e-99),
        some=[] if named == len(found) else [{"named": named, "count": len(found)}],
        others=others,
    )


def drive(case: CaseView, *, level: float) -> Answer:
    drive = case["Omega"] / (2 * np.pi)
    (every,) = measures.loudest(case.lines(*EARLY, above=0.5 * drive), 1)
    window = case.signal(*EARLY)
    found = [case.strongest(window, n * drive, 0.4 * drive) for n in (1, 2, 3)]
    levels = [20 * np.log10(line.amplitude / found[0].amplitude) for line in found]
    near = all(abs(line.frequency - n * drive) < 0.05 for n, line in zip((1, 2, 3), found, strict=True))
    strongest = every.amplitude <= found[0].amplitude * (1 + 1e-9)
    rows = [{"Hz": line.frequency, "dB": x} for line, x in zip(found, levels, strict=True)]
    loud = min(line.amplitude for line in found) > level * found[0].amplitude
    return Answer(near and strongest and loud, lines=rows)


def follow(*cases: CaseView, within: float) -> Answer:
    """Whether the lines move with the disc's frequencies or with the stick-slip rate when that is changed."""
    rows, off, away, near = [], [], [], []
    for case in cases:
        found = sorted(measures.loudest(case.lines(*EARLY, above=100, below=300, apart=1.0), 6))
        rate = stick_slip_rate(case)
        off += [_from_combination(case, line, rate) for line in found]
        away += [_from_natural(case, line) for line in found]
        near += [_from_natural(case, line) <= 4 * case["Omega"] / (2 * np.pi) for line in found]
        lines = [line.frequency for line in found]
        rows.append({"case": case, "rate": rate, "lines": lines})
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
    rate, drive = stick_slip_rate(case), case["Omega"] / (2 * np.pi)
    found = measures.loudest(case.lines(*EARLY, above=40, below=100, apart=1.0), 2)
    pair, split = sorted(line.frequency for line in found), [rate - drive, rate + drive]
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
        spring=100 * spring,
    )


def _level(case: CaseView, frequency: float) -> float:
    """Largest amplitude of the disc's point within 1 Hz of a frequency, relative to that of all above 1 Hz."""
    found, amplitude = spectra.amplitude_spectrum(*case.signal("late", 0.0, np.inf))
    near, every = (float(amplitude[at].max()) for at in (np.abs(found - frequency) < 1, found > 1))
    return measures.ratio(near, every, f"the spectrum of case {case.name}")


def inplane_contribution(case: CaseView, *, share: float) -> Answer:
    rate = stick_slip_rate(case)
    found = case.lines(*EARLY, above=LOW, below=HIGH, floor=1e-3)
    power = sum(line.amplitude**2 for line in found)
    made = [line for line in found if _from_combination(case, line, rate) <= COMBINED]
    percent = 100 * sum(line.amplitude**2 for line in made) / power
    return Answer(percent > 100 * share, percent=percent, made=len(made), count=len(found), rate=rate, low=LOW)


def three_kinds(case: CaseView, *, factor: float) -> Answer:
    spans = (EARLY, LATER, LATE)
    ranges = [float(np.ptp(case.signal(*span)[1])) for span in spans]
    filled = [_fuzziness(case, *span) for span in spans]
    rates = [case.slope("P", max(start, 1), stop) for _, start, stop in spans]
    grown = [max(rate, STILL) for rate in rates]
    kinds = zip(ranges, filled, grown, strict=True)
    differ = [
        any(max(pair) >= factor * min(pair) for pair in zip(one, other, strict=True))
        for one, other in combinations(kinds, 2)
    ]
    rows = [
        {"start": start, "stop": stop, "mm": 1e3 * width, "percent": 100 * share, "rate": rate}
        for (_, start, stop), width, share, rate in zip(spans, ranges, filled, rates, strict=True)
    ]
    return Answer(all(differ), spans=rows)


def new_lines(case: CaseView, *, factor: float, floor: float) -> Answer:
    """Whether lines appear that, unlike all main ones, do not combine the stick-slip frequency and the drive's."""
    rate = stick_slip_rate(case)
    early, later = (
        sum(
            _from_combination(case, line, rate) > COMBINED
            for line in case.lines(*span, above=LOW, below=300.0, floor=floor)
        )
        for span in (EARLY, LATER)
    )
    return Answer(later > factor * max(early, 1), early=early, later=later)


def higher(case: CaseView, bonded: CaseView, *, factor: float, floor: float) -> Answer:
    first = case["first_separation"]
    spans = (("spectrum_c", 50, first), ("spectrum_c", first, 60), LATE)
    (before, after, late), ignored = ([_power_share(each, *span) for span in spans] for each in (case, bonded))
    here, there = (b > max(factor * a, floor) for a, b in ((before, after), ignored[:2]))
    return Answer(*_beside(here, there), high=HIGH, low=LOW, before=before, after=after, late=late, ignored=ignored)


def _beside(here: bool, there: bool) -> tuple[bool | None, str]:
    """Whether something changes with separation; undecided if it changes without separation as well."""
    return None if here and there else here, "control"


def steady_lines(*pair: CaseView, part: float, within: float) -> Answer:
    rows, found = [], []
    for case in pair:
        before, after = _fuzziness(case, *LATER), _fuzziness(case, *LATE)
        first, second = (case.lines("spectrum_d", *span, above=LOW, floor=1e-2) for span in ((100, 105), (105, 110)))
        drift = max(min(abs(a.frequency - b.frequency) for b in second) for a in first)
        found.append(after < part * before and drift < within)
        rows.append({"case": case, "before": 100 * before, "after": 100 * after, "drift": drift})
    return Answer(*_beside(*found), stretches=rows)


def slider_settles(*pair: CaseView, part: float) -> Answer:
    first = pair[0]["first_separation"]
    length = first - 50
    begins = {"before": ("spectrum_c", 50.0), "after": ("spectrum_c", first), "late": ("spectrum_d", 100.0)}
    filled = [
        [100 * _fuzziness(case, window, start, start + length, "psi") for window, start in begins.values()]
        for case in pair
    ]
    rows = [{"case": case} | dict(zip(begins, each, strict=True)) for case, each in zip(pair, filled, strict=True)]
    (before, after, _), (ignored, control, late) = filled
    found = _beside(after < part * before, control < part * ignored)
    return Answer(*found, stretches=rows, later=late < part * ignored and late)


def multiples(case: CaseView, *, bound: float) -> Answer:
    first = case["first_separation"]
    late = _lines_of_psi(case, *LATE)
    rate = late[0].frequency
    before = _off_multiples(_lines_of_psi(case, "spectrum_c", 50, first), rate)
    after = _off_multiples([*_lines_of_psi(case, "spectrum_c", first, 60), *late], rate)
    return Answer(
        max(after) <= bound,
        rate=rate,
        count=len(after),
        worst=max(after),
        others=sum(off > bound for off in before),
        before=len(before),
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
    free, kept = (1e3 * each.late_range("w_point").width for each in (case, bonded))
    numbers = {"slow": slow, "sharp": sharp, "at": starts[peak] + 2.5, "last": last, "after": after}
    return Answer(*_beside(stages and here, stages and there), free=free, kept=kept, **numbers)


def natural_lines(case: CaseView, *, share: float, near: float) -> Answer:
    span = ("spectrum_d", 143.0, 153.0)
    drive, rate = case["Omega"] / (2 * np.pi), stick_slip_rate(case, *span)
    found, every = (measures.loudest(case.lines(*span, above=above, floor=1e-3), 4) for above in (LOW, 0.5 * drive))
    ours, counted = (_natural_share(case, lines, rate, near) for lines in (found, every))
    return Answer(
        None if counted <= share < ours else ours > share,
        "drive",
        low=LOW,
        lines=[line.frequency for line in found],
        percent=100 * ours,
        lowest=_natural(case)[0],
        rate=rate,
        counted=100 * counted,
    )


def fuzz_stays(*pair: CaseView, part: float, factor: float, floor: float) -> Answer:
    first = pair[0]["first_separation"]
    spans = (("spectrum_d", first - 4, first), ("spectrum_d", first, first + 4))
    rows, found = [], []
    for case in pair:
        before, after = (100 * _fuzziness(case, *span) for span in spans)
        low, high = (_power_share(case, *span) for span in spans)
        found.append(after > before / part and high > max(factor * low, floor))
        rows.append({"case": case, "before": before, "after": after, "high_before": low, "high_after": high})
    return Answer(*_beside(*found), stretches=rows)


def no_high_line(case: CaseView, *, share: float) -> Answer:
    omega = float(plate_modes(case.parameters)["omega"].max())
    base = float(plate_modes(case.parameters.replace(E=150e9))["omega"].max())
    spans = (("spectrum_d", 465, 475), ("spectrum_late", 1490, 1500))
    first, last = (_power_share(case, *span, omega / (2 * np.pi)) for span in spans)
    return Answer(max(first, last) < share, omega=omega, low=LOW, first=first, last=last, base=base)


def lines_shift(case: CaseView, *, part: float, floor: float, apart: float) -> Answer:
    """Whether weak lines of one stretch are missing in the next."""
    first, second = (
        case.lines("spectrum_d", *span, above=LOW, below=600, floor=floor) for span in ((465, 470), (470, 475))
    )
    weak = [line for line in first if line.amplitude < 0.1 * max(each.amplitude for each in first)]
    moved = [line for line in weak if min(abs(line.frequency - other.frequency) for other in second) > apart]
    return Answer(len(moved) > part * len(weak), moved=len(moved), count=len(weak))


def erratic(case: CaseView, *, several: float, part: float, apart: float) -> Answer:
    """Whether the spectrum is erratic; undecided if the number of frequencies depends on the resolution of lines."""
    rate = stick_slip_rate(case, "spectrum_d", 465, 475)
    found = case.lines("spectrum_d", 465, 475, above=LOW, below=600, floor=1e-2)
    strongest = max(line.amplitude for line in found)
    every, coarse = (_further(found, rate, case["Omega"] / (2 * np.pi), width) for width in (apart, 2 * apart))
    further, fewer = ([line for line in lines if line.amplitude >= part * strongest] for lines in (every, coarse))
    motion, _ = case.late_motion()
    second = further[1].amplitude / further[0].amplitude if len(further) > 1 else 1.0
    holds, why = is_kind(Outcome.IRREGULAR, motion, len(further) >= several)
    depends = holds and len(fewer) < several
    return Answer(
        None if depends else holds,
        "width" if depends else why,
        fewer=len(fewer),
        double=2 * apart,
        count=len(found),
        rate=rate,
        further=len(further),
        seen=[f"{line.frequency:.2f} Hz ({line.amplitude / strongest:.2g})" for line in further] or ["none"],
        weak=len(every) - len(further),
        mainly=second < 0.5,
        second=second,
    )


def _lines_of_psi(case: CaseView, window: str, start: float, stop: float) -> list[spectra.Line]:
    """Lines of psi above a hundredth of the strongest, by ascending frequency."""
    return case.lines(window, start, stop, "psi", above=LOW, below=HIGH, floor=1e-2)


def _off_multiples(lines: list[spectra.Line], rate: float) -> list[float]:
    """Distance of each line from the nearest multiple of a rate, Hz."""
    return [abs(line.frequency - max(round(line.frequency / rate), 1) * rate) for line in lines]


def _natural(case: CaseView) -> Any:
    """Natural frequencies with the slider attached, Hz."""
    return coupled_natural_frequencies(case.parameters) / (2 * np.pi)


def _from_combination(case: CaseView, line: spectra.Line, rate: float) -> float:
    """Distance of a line from the nearest n f_s + m f_Omega, Hz."""
    return abs(spectra.identify(line.frequency, rate, case["Omega"] / (2 * np.pi)).deviation)


def _from_natural(case: CaseView, line: spectra.Line) -> float:
    """Distance of a line from the nearest natural frequency with the slider attached, Hz."""
    return float(np.min(np.abs(_natural(case) - line.frequency)))


def _natural_share(case: CaseView, lines: list[spectra.Line], rate: float, near: float) -> float:
    """Fraction of the lines' power in lines beside a natural frequency that are not near any n f_s + m f_Omega."""
    within = 4 * case["Omega"] / (2 * np.pi)
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


def _fuzziness(case: CaseView, window: str, start: float, stop: float, name: str = "w_point") -> float:
    """Fraction of 20..300 Hz where a variable's amplitude exceeds 1e-4 of the strongest there.

    Only stretches of equal length, with equal resolution, can be compared.
    """
    return spectra.coverage(*case.signal(window, start, stop, name), LOW, 300.0, floor=1e-4)


def _power_share(case: CaseView, window: str, start: float, stop: float, above: float = HIGH) -> float:
    """Ratio of the power above a frequency in Hz to that above `LOW`."""
    case.lines(window, start, stop, above=LOW)  # raises Missing without any line
    return spectra.power_share(*case.signal(window, start, stop), above, LOW)
