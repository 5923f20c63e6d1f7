"""Rows on Section 4.4, frequencies and how they change with time, and on the conclusions."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.parameters import Parameters
from workflow.paper import growth as growth_rates
from workflow.paper import measures, paper_tables, signals
from workflow.paper.measures import HIGH, LOW, Array, CaseView, Mask
from workflow.paper.model import FALSE, NOT_TESTED, PART, TRUE, Answer, graded, partly
from workflow.paper.section2 import BASE
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
BEFORE_SEPARATION = 4.0
"""Time before the first separation in which a spectrum is taken, s."""


def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    """Judge the printed time of the first separation, s."""
    off = abs(case["first_separation"] - printed)
    return Answer(off <= within, contact=case.contact.capitalize())


def natural_frequencies(case: CaseView) -> Array:
    """Return natural frequencies with the slider attached, Hz."""
    return np.asarray(coupled_natural_frequencies(case.parameters) / (2 * np.pi))


# ---- Lines of the spectrum


def rest_late(case: CaseView, *, within: float) -> Answer:
    """Judge whether lines move by more than a number of Hz early and late."""
    drifts = [_drift(case, stretch) for stretch in (EARLY, LATE)]
    verdict = graded(each.high > within for each in drifts)
    return Answer(verdict, drifts=drifts, first=case["first_separation"])


def _drift(case: CaseView, stretch: Stretch) -> measures.Range:
    """Return how far lines move between the halves of a stretch, at least and at most, Hz."""
    window, start, stop = stretch
    half = (start + stop) / 2
    first = case.signal(window, start, half).lines(above=LOW, floor=1e-2)
    second = case.signal(window, half, stop).lines(above=LOW, floor=1e-2)
    later = np.array([line.frequency for line in second])
    return measures.extent(np.min(np.abs(later - line.frequency)) for line in first)


def constant_by_separation(case: CaseView, bilateral: CaseView, *, within: float) -> Answer:
    """Judge whether lines come to rest by separation.

    Parameters
    ----------
    case, bilateral : with separation and without it
    within : Hz by which lines at rest may move
    """
    drift = _drift(case, LATE).high
    other = _drift(bilateral, LATE).high
    verdict = partly(drift <= within, other <= within)
    return Answer(verdict, drift=drift, other=other)


def lines(case: CaseView, *, bound: float) -> Answer:
    """Judge the printed lines of Table 2.

    Parameters
    ----------
    case : the run
    bound : greatest difference of a line from the printed one, Hz
    """
    found = paper_tables.table_2_lines(case)
    table = paper_tables.table_2(case)
    signal = case.signal(*EARLY)
    most = np.abs(table["ours_Hz"] - table["paper_Hz"]).max()
    chances = [
        signals.chance(signal.time, signal.values, line, paper_tables.SEARCHED) for line in found
    ]
    chance = len(found) * max(chances)
    rows = []
    for row in table.itertuples():
        rows.append(f"{row.ours_Hz:.2f} ({row.paper_Hz:g}, {row.ours_is})")
    return Answer(
        most <= bound and chance <= 1e-3,
        off=most,
        named=(table["ours_is"] != paper_tables.UNNAMED).sum(),
        rate=paper_tables.stick_slip_rate(case),
        rows=rows,
    )


def follow(*cases: CaseView, within: float) -> Answer:
    """Judge whether the lines are natural frequencies, shifted by the drive.

    In part if they are combinations of the stick-slip rate with the drive's frequency.

    Parameters
    ----------
    cases : the runs
    within : Hz by which lines may differ
    """
    combined: list[bool] = []
    shifted: list[bool] = []
    natural: list[bool] = []
    orders = np.array([-3, -2, -1, 1, 2, 3])
    for case in cases:
        rate = paper_tables.stick_slip_rate(case)
        expected = np.add.outer(natural_frequencies(case), case.drive * orders)
        strongest = case.signal(*EARLY).lines(6, above=100, below=300, apart=1.0)
        for line in sorted(strongest):
            name = spectra.identify(line.frequency, rate, case.drive)
            combined.append(abs(name.deviation) <= within)
            shifted.append(name.m != 0)
            off = np.min(np.abs(expected - line.frequency))
            natural.append(bool(off <= within))
    verdict = FALSE
    if all(natural):
        verdict = TRUE
    elif all(combined) and np.mean(shifted) >= 0.5:
        verdict = PART
    return Answer(verdict, combined=combined, shifted=shifted, natural=natural)


def inplane_frequency(case: CaseView, *, printed: float, within: float) -> Answer:
    """Judge the printed in-plane frequency of the slider, which the drive splits.

    Parameters
    ----------
    case : the run
    printed : frequency, Hz
    within : Hz by which the stick-slip rate may differ from it
    """
    rate = paper_tables.stick_slip_rate(case)
    pair = paper_tables.table_2(case).iloc[1:3]
    names = [*pair["ours_is"]]
    holds = abs(rate - printed) <= within
    free: float | str = ""
    if not holds:
        free = _own_frequency(case["k_p"], case["m"])
    return Answer(
        graded([names == ["f_s − f_Ω", "f_s + f_Ω"], holds]),
        rate=rate,
        drive=case.drive,
        lines=[*pair["ours_Hz"]],
        names=names,
        free=free,
    )


def _own_frequency(stiffness: float, mass: float) -> float:
    """Return the natural frequency of a mass on a spring, Hz."""
    return float(np.sqrt(stiffness / mass)) / (2 * np.pi)


def close_to_natural(case: CaseView, *, within: float) -> Answer:
    """Judge whether the six higher lines of Table 2 are natural frequencies, within Hz; some in part."""
    natural = natural_frequencies(case)
    rows = []
    far = 0
    computed = paper_tables.table_2(case)["ours_Hz"].to_numpy()[3:]
    for frequency in computed:
        nearest = natural[np.argmin(np.abs(natural - frequency))]
        far += bool(abs(nearest - frequency) > within)
        rows.append(f"{frequency:.1f} Hz ({nearest:.1f} Hz)")
    verdict = partly(far < computed.size, far > 0)
    return Answer(verdict, rows=rows, far=(far, computed.size))


def inplane_contribution(case: CaseView, *, share: float) -> Answer:
    """Judge whether a share of the power is in combinations of the stick-slip rate."""
    rate = paper_tables.stick_slip_rate(case)

    def is_combination(frequency: float) -> bool:
        return abs(spectra.identify(frequency, rate, case.drive).deviation) <= paper_tables.COMBINED

    found = case.signal(*EARLY).lines(above=LOW, below=HIGH, floor=1e-3)
    combinations = [line for line in found if is_combination(line.frequency)]
    part = _power(combinations) / _power(found)
    anywhere = [is_combination(frequency) for frequency in np.arange(LOW, HIGH, 0.2)]
    return Answer(
        part > share,
        counts=(len(combinations), len(found)),
        rate=rate,
        drive=case.drive,
        part=part,
        near=np.mean(anywhere),
    )


def _power(found: Sequence[spectra.Line]) -> float:
    """Return the sum of the squares of the amplitudes of lines."""
    return sum(line.amplitude**2 for line in found)


# ---- Power at high frequencies, and fuzz between lines


def higher(
    *cases: CaseView, factor: float, floor: float, windows: str, spans: Sequence[float]
) -> Answer:
    """Judge whether power above `HIGH` appears with the first separation.

    Parameters
    ----------
    cases : with separation and without it, in turn
    factor : by which the share of power must rise
    floor : share of power that must be reached
    windows : names of the windows to look in, one for each pair
    spans : for each pair, when what is compared begins before the first separation, and when it
        ends after it, s
    """
    rows = []
    rises = []
    also_without = []
    places = zip(cases[::2], cases[1::2], windows.split(), spans[::2], spans[1::2], strict=True)
    for case, bilateral, window, low, high in places:
        first = case["first_separation"]
        before = case.signal(window, low, first).power_above(HIGH)
        after = case.signal(window, first, high).power_above(HIGH)
        control_before = bilateral.signal(window, low, first).power_above(HIGH)
        control_after = bilateral.signal(window, first, high).power_above(HIGH)
        rises.append(after > max(factor * before, floor))
        also_without.append(control_after > max(factor * control_before, floor))
        rows.append((case.place, before, after, control_after, low, first, high))
    return Answer(partly(all(rises), any(also_without)), rows=rows)


def fuzz_goes(*pair: CaseView, share: float) -> Answer:
    """Judge whether fuzz falls below a share of what it was, with separation.

    Parameters
    ----------
    pair : with separation and without it
    share : of the filled band
    """
    filled = []
    for case in pair:
        filled += _filled(case, LATER, LATE)
    return Answer(filled[1] < share * filled[0], filled=filled)


def _filled(case: CaseView, *stretches: Stretch, name: str = "w_point") -> list[float]:
    """Return the share of the band that the spectrum of a variable fills in stretches."""
    return [case.signal(*stretch, name).filled for stretch in stretches]


def _falls(filled: Sequence[float], share: float) -> bool:
    """Return whether the last of the shares is below a part of the first."""
    return filled[-1] < share * filled[0]


def explained_by_slider(*pair: CaseView, share: float) -> Answer:
    """Judge whether fuzz goes where it goes in the slider's motion.

    If so, the cause is not tested, because no run changes the slider's spectrum alone.

    Parameters
    ----------
    pair : with separation and without it
    share : of the filled band, below which fuzz has gone
    """
    first = pair[0]["first_separation"]
    length = first - 50
    of_slider = (
        Stretch("spectrum_c", 50.0, 50.0 + length),
        Stretch("spectrum_c", first, first + length),
        Stretch("spectrum_d", 100.0, 100.0 + length),
    )
    disc = [_filled(case, LATER, LATE) for case in pair]
    slider = [_filled(case, *of_slider, name="psi") for case in pair]
    gone_from_disc = [_falls(filled, share) for filled in disc]
    gone_from_slider = [_falls(filled, share) for filled in slider]
    verdict = FALSE
    if gone_from_disc[0] and gone_from_disc == gone_from_slider:
        verdict = NOT_TESTED
    before = {"disc": LATER[1:], "slider": of_slider[0][1:]}
    return Answer(verdict, disc=disc, slider=slider, before=before)


def at_natural_frequencies(case: CaseView, *, within: float, share: float, turns: float) -> Answer:
    """Judge whether lines at natural frequencies have most of the power before separation.

    A point fixed on the disc sees them shifted by multiples of the drive's frequency.

    Parameters
    ----------
    case : the run, with the window ``spectrum_d``
    within : Hz within which a line is at such a frequency
    share : of the power
    turns : greatest multiple of the drive's frequency
    """
    first = case["first_separation"]
    begin = first - BEFORE_SEPARATION
    natural = natural_frequencies(case)
    multiples = case.drive * np.arange(-turns, turns + 1)
    expected = np.add.outer(natural, multiples).ravel()

    def is_natural(frequency: float) -> bool:
        return bool(np.min(np.abs(expected - frequency)) <= within)

    found = case.signal("spectrum_d", begin, first).lines(above=LOW, floor=1e-3)
    part = _power([line for line in found if is_natural(line.frequency)]) / _power(found)
    strongest = sorted(found, key=lambda line: -line.amplitude)[:2]
    rate = case.signal("spectrum_d", begin, first, "psi").lines(1, above=LOW)[0].frequency
    anywhere = [is_natural(frequency) for frequency in np.arange(LOW, HIGH, 0.2)]
    return Answer(
        part > share,
        part=part,
        span=(begin, first),
        strongest=sorted(line.frequency for line in strongest),
        coupled=natural[0],
        rate=rate,
        near=np.mean(anywhere),
    )


def fuzz_stays(*pair: CaseView, share: float) -> Answer:
    """Judge whether fuzz keeps a share of what it was over the first separation.

    Parameters
    ----------
    pair : with separation and without it
    share : of the filled band
    """
    first = pair[0]["first_separation"]
    before = Stretch("spectrum_d", first - 4, first)
    after = Stretch("spectrum_d", first, first + 4)
    filled = []
    for case in pair:
        filled += _filled(case, before, after)
    return Answer(filled[1] >= share * filled[0], filled=filled, first=first)


def no_high_line(case: CaseView, *, share: float, printed: float) -> Answer:
    """Judge whether power above the highest natural frequency is less than a share.

    Parameters
    ----------
    case : the run
    share : of the power
    printed : this natural frequency in the paper, rad/s; another one is a reservation
    """
    omega = float(plate_modes(case.parameters)["omega"].max())
    highest = omega / (2 * np.pi)
    first = case.signal("spectrum_d", 465, 475).power_above(highest)
    last = case.signal("spectrum_late", 1490, 1500).power_above(highest)
    verdict = partly(max(first, last) < share, abs(omega - printed) > 0.01)
    return Answer(verdict, shares=(first, last), omega=omega, base=BASE.E)


# ---- Stages of the motion


def later_periodic(case: CaseView, bilateral: CaseView) -> Answer:
    """Judge whether the late motion is periodic; that without separation is told if it is."""
    periodic = case.late_motion.period > 0
    other = ""
    if bilateral.late_motion.period > 0:
        other = bilateral.motion
    return Answer(periodic, motion=case.motion, span=case.kept_span, other=other)


def growth_stages(case: CaseView, *, factor: float, least: float) -> Answer:
    """Judge whether the disc's vibration grows slowly, then sharply, then slowly.

    Parameters
    ----------
    case : the run
    factor : by which growth must be faster in the sharp stage than at first
    least : growth rate that it must reach there, 1/s
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
    sharp = float(rates.max())
    last = case.slope("w_point", first - 3, first)
    after = case.slope("w_point", end - 20, np.inf)
    return Answer(
        sharp > max(factor * slow, least) and last < sharp,
        rates=(slow, sharp, last, after),
        when=starts[rates.argmax()] + 2.5,
        first=first,
    )


# ---- The conclusions, as far as the rows on the sections do not judge them


def reattaches(*cases: CaseView, longest: float) -> Answer:
    """Judge whether each separation ends with contact.

    Parameters
    ----------
    cases : the runs
    longest : time in s before the end of a run, from which on a separation need not have ended
    """
    begins = 0
    ends = 0
    lasts = 0.0
    holds = []
    for case in cases:
        end = case.kept_span.high
        starts = case.times_of("separation")
        starts = starts[starts <= end - longest]
        if not starts.size:
            raise Missing(f"case {case.name} keeps no separation")
        contacts = case.times_of("reattachment")
        following = np.searchsorted(contacts, starts)
        ended = following < contacts.size
        durations = contacts[following[ended]] - starts[ended]
        lasts = max(lasts, float(durations.max(initial=0.0)))
        begins += starts.size
        ends += int(ended.sum())
        holds.append(ended.all())
    return Answer(graded(holds), cases=len(cases), begins=begins, ends=ends, lasts=1e3 * lasts)


def caused_by_friction(*cases: CaseView, growth: float) -> Answer:
    """Judge whether a case separates that is stable without friction.

    Parameters
    ----------
    cases : the runs
    growth : rate of steady sliding in 1/s below which a case counts as stable
    """
    frictionless = []
    by_friction = False
    for case in cases:
        rate = growth_rates.sliding_growth(case.parameters.replace(mu_s=0.0, mu_k=0.0))
        frictionless.append(rate)
        by_friction = by_friction or (case.separates and rate < growth)
    rows = [case.fate for case in cases]
    return Answer(by_friction, rows=rows, most=max(frictionless))


def not_monotonous(*evidence: Any) -> Answer:
    """Judge whether preload, in-plane damping and in-plane stiffness act both ways.

    Parameters
    ----------
    evidence : three cases by rising preload, and last the map of preload and in-plane damping
    """
    *cases, study = evidence
    load = [(case.separates, case.growth_rate > 0) for case in cases]
    load_acts_both_ways = load == [(False, False), (True, True), (False, False)]

    over_damping = plane(study, "N", "c_p")
    newly = over_damping.newly_separating()
    undamped = over_damping.growth[:, 0]
    damped = over_damping.growth[:, -1]
    growing = (undamped > 0) & np.isfinite(damped)
    lowered = growing & (damped < undamped)
    damping_acts_both_ways = newly.any() and lowered.any()

    [over_stiffness], words = stiffened(cases[0].parameters.replace(N=300), 50)
    signs = {*np.sign(np.diff(over_stiffness))}
    stiffness_acts_both_ways = signs >= {-1, 1}
    return Answer(
        load_acts_both_ways and damping_acts_both_ways and stiffness_acts_both_ways,
        fates=[case.fate for case in cases],
        most=over_damping.second[-1],
        newly=[*over_damping.first[newly]],
        counts=(lowered.sum(), growing.sum()),
        stiffened=words,
    )


def damping_destabilises(study: xr.Dataset, *, fewest: float) -> Answer:
    """Judge whether in-plane damping brings separation at large preloads.

    Parameters
    ----------
    study : map of preload and in-plane damping
    fewest : preload in N from which on it is large
    """
    over_damping = plane(study, "N", "c_p")
    loads = over_damping.first
    newly = loads[over_damping.newly_separating() & (loads >= fewest)]
    return Answer(newly.size > 0, most=over_damping.second[-1], rows=[*newly])


STIFFENED = (2, 20, 30, 36, 47, 55, 63, 73, 84, 130, 200)
"""In-plane stiffnesses, kN/m: those of the paper, and others between them."""


def stiffer_inplane(case: CaseView) -> Answer:
    """Judge whether growth rises with the in-plane stiffness, as long as the cycle grows."""
    over_stiffness, words = stiffened(case.parameters, 20, 50)
    rises = []
    for rates in over_stiffness:
        first_decay = np.argmax(np.append(rates, -1) < 0)
        growing = rates[:first_decay]
        steps = np.diff(growing)
        rises.append(steps.size > 0 and bool((steps > 0).all()))
    return Answer(graded(rises), rises=rises, stiffened=words)


def stiffened(p: Parameters, *speeds: float) -> tuple[list[Array], str]:
    """Compute growth rates with `STIFFENED`.

    Parameters
    ----------
    p : the case
    speeds : at which it is computed, rad/s

    Returns
    -------
    list of arrays
        For each speed, growth rates of the cycles that there are, 1/s.
    str
        All of them in words.
    """
    known = []
    sentences = []
    for speed in speeds:
        rates = []
        words = []
        for k_p in STIFFENED:
            rate = growth_rates.growth_of(p.replace(k_p=1e3 * k_p, Omega=speed))
            words.append(f"{measures.rate_text(rate)} at {k_p}")
            if math.isfinite(rate):
                rates.append(rate)
        sentences.append(
            f"At {measures.place(p.N, speed)}, growth (1/s) at each k_p (kN/m) is as follows: "
            f"{'; '.join(words)}."
        )
        known.append(np.array(rates))
    return known, " ".join(sentences)


def soft_enough(study: xr.Dataset, *, slow: float) -> Answer:
    """Judge whether a soft disc keeps contact and a stiff one loses it.

    Parameters
    ----------
    study : map of elastic modulus and speed
    slow : speed of the paper's example, rad/s
    """
    modulus, Omega, separates, *_ = plane(study, "E", "Omega")
    modulus = modulus / 1e9
    some = separates.any(axis=1)
    quiet = [*modulus[~some]]
    stiffest_quiet = max(quiet, default=0.0)
    softer = [*modulus[some & (modulus < stiffest_quiet)]]
    if not quiet or not some.any():
        verdict = FALSE
    elif softer:
        verdict = PART
    else:
        verdict = TRUE

    example: float | str = ""
    no_stiffer = modulus <= BASE.E / 1e9
    at_slow = separates[no_stiffer][:, Omega == slow]
    if at_slow.size and not at_slow.any():
        example = slow
    return Answer(verdict, quiet=quiet, softer=softer, slow=example, base=BASE.E)


def four_contributions(
    case: CaseView, *stiffened: CaseView, near: float, share: float, within: float
) -> Answer:
    """Judge whether rotation, disc and both branches of the slider all contribute frequencies.

    Parameters
    ----------
    case : run of Table 2
    stiffened : runs in pairs, the second with a stiffer spring k
    near : Hz within which a line is at a natural frequency
    share : of the power, which combinations of the stick-slip rate must have
    within : relative difference up to which two rises count as equal
    """
    named = paper_tables.table_2(case)["ours_is"].iloc[3:]
    turned = int(named.str.contains("f_Ω").sum())
    natural = close_to_natural(case, within=near)
    horizontal = inplane_contribution(case, share=share)
    vertical = _vertical_branch(*stiffened, within=within)
    contributes = [
        turned > 0,
        natural.verdict == TRUE,
        horizontal.verdict == TRUE,
        vertical.pop("contributes"),
    ]
    return Answer(
        graded(contributes),
        turned=turned,
        far=natural.values["far"],
        part=horizontal.values["part"],
        **vertical,
    )


def _vertical_branch(*cases: CaseView, within: float) -> dict[str, Any]:
    """Return whether the rate of separations follows a frequency of the slider normal to the disc.

    It comes with values for the row's text. The frequency may be that of the coupled mode, or that
    of the slider on its spring alone.

    Parameters
    ----------
    cases : in pairs, the second with a stiffer spring k
    within : relative difference up to which two rises count as equal
    """
    rows = []
    over_mode = []
    over_spring = []
    coupled = math.nan
    for soft, stiff in zip(cases[::2], cases[1::2], strict=True):
        rate = 1 / float(soft.intervals("separation").mean())
        stiff_rate = 1 / float(stiff.intervals("separation").mean())
        rise = stiff_rate / rate - 1

        coupled = natural_frequencies(soft)[0]
        mode_rise = natural_frequencies(stiff)[0] / coupled - 1
        spring_rise = math.sqrt(stiff["k"] / soft["k"]) - 1
        over_mode.append(rise / mode_rise)
        over_spring.append(rise / spring_rise)
        rows.append((soft.place, rate))
    by_mode = all(abs(each - 1) <= within for each in over_mode)
    by_spring = all(abs(each - 1) <= within for each in over_spring)
    return {
        "contributes": by_mode or by_spring,
        "rows": rows,
        "coupled": coupled,
        "free": _own_frequency(cases[0]["k"], cases[0]["m"]),
        "follows": over_mode,
    }


def errs(*evidence: Any, within: float, share: float) -> Answer:
    """Judge whether ignoring separation gives other ranges where contact is lost, on two discs.

    Parameters
    ----------
    evidence : cases with separation and without it, which form pairs, and last the study of the
        brake-like disc
    within : share by which a range must differ
    share : of the motions with separation, in which it has to
    """
    *cases, study = evidence
    of_disc = []
    of_slider = []
    for case, bilateral in measures.pairs(cases):
        of_disc.append(1 / measures.width_ratio(case, bilateral))
        inplane = case.late_range("psi").width
        what = f"the range of psi in case {case.name}"
        of_slider.append(measures.ratio(bilateral.late_range("psi").width, inplane, what))
    disc = _errors(np.array(of_disc), within)
    slider = _errors(np.array(of_slider), within)

    # the brake-like disc: late ranges of the slider's height
    surface = study.sel(disc="surface")
    free = surface.sel(contact="unilateral")
    width = (surface["u_max"] - surface["u_min"]).reset_coords(drop=True)
    ratios = width.sel(contact="bilateral") / width.sel(contact="unilateral")
    separates = flag_names(free["outcome"]) == "separation"
    brake = _errors(ratios.transpose(*free["outcome"].dims).values[separates], within)
    kept_on = flag_names(surface.sel(contact="bilateral")["outcome"])[separates]

    wrong = disc.any(axis=0) | slider.any(axis=0)
    on_both = [wrong.mean() >= share, separates.any() and brake.any(axis=0).mean() >= share]
    return Answer(
        graded(on_both),
        wider=(int(disc[0].sum()), wrong.size),
        narrower=(int(disc[1].sum()), wrong.size),
        more=(int(slider[0].sum()), wrong.size),
        less=(int(slider[1].sum()), wrong.size),
        brake=(int(brake[0].sum()), int(brake[1].sum())),
        of=int(separates.sum()),
        unsettled=int(np.isin(kept_on, ("growing", "undecided")).sum()),
        kept=int((~separates).sum()),
        after=stated_in(study, "options")["after_separation"],
    )


def _errors(ratios: Array, within: float) -> Mask:
    """Return which ratios of ranges are too large, and which too small, shape (2, ratios)."""
    return np.stack([ratios > 1 + within, ratios < 1 / (1 + within)])
