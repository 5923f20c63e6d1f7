"""Warnings of values that are allowed but implausible, such as E = 150, which was probably meant in
GPa."""

import math
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from types import FrameType

import numpy as np

from disc_model.disc.plate import are_elsewhere, mode_arrays, shapes_at_slider
from disc_model.disc.thin_plate import shortest_wave
from disc_model.display import counted, frequencies_text
from disc_model.errors import DiscModelError
from disc_model.parameters import DEFAULTS, Disc, Parameters

INNER = ("disc_model", "functools", "contextlib")  # modules between a reader and a warning
# Damping ratio of a mode from which it is doubted: discs of metal have 0.0001 to 0.01, and per cent would be numbers
# a hundred times as large.
MOST_DAMPED = 0.05
_TOO_DAMPED = f"more than {MOST_DAMPED:g}: it is a fraction of critical damping, not per cent"
TOO_HIGH = 0.1  # relative excess of a frequency of the thin plate from which a mode is doubted
APART = 20.0  # ratio of a frequency to the nearest other one beyond which its unit is doubted
WIDE = 50.0  # ratio of neighbouring frequencies beyond which those below are taken for kHz

MEASURES = ("a", "b", "h", "E", "nu", "rho")
"""Numbers of the plate by which it is another than the paper's."""
STATED_WITH_MEASURES = ("normalization", "D_star", "damping_ratio")
"""What a case of another plate has to state."""


class ImplausibleValue(UserWarning):
    """A value is allowed but implausible.

    Examples
    --------
    >>> import disc_model as dm
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     run = dm.simulate(dm.Parameters(N=385, Omega=15, E=150), 1e-3)
    >>> {warning.category.__name__ for warning in caught}
    {'ImplausibleValue'}
    """


def doubts(p: Parameters) -> dict[str, str]:
    """Messages on implausible values of a case, by the rule that gives them."""
    return {kind: text for kind, doubt in RULES.items() if (text := doubt(p))}


_reported: set[tuple[object, ...]] = set()  # rules, and for those on a disc its numbers
_on_trial = ContextVar("_on_trial", default=False)


@contextmanager
def trial_cases() -> Iterator[None]:
    """Within it cases are tried, and their implausible values are neither reported nor counted as
    reported."""
    token = _on_trial.set(True)
    try:
        yield
    finally:
        _on_trial.reset(token)


def warn_of_doubts(p: Parameters, tell: Callable[[str], object] | None = None) -> None:
    """Report implausible values of a case by each rule, once in a process, or once for each disc
    that is given by its modes; by default as a warning."""
    if _on_trial.get():
        return
    for kind, text in doubts(p).items():
        told = _told_of(kind, p.disc)
        if told not in _reported:
            _reported.add(told)
            (tell or _warn)(text)


def is_told(kind: str) -> bool:
    """Whether a doubt of cases was reported in this process, or is not to be, since cases are tried."""
    return _on_trial.get() or (kind,) in _reported


def note_told(kind: str) -> None:
    """Have a doubt of cases that is not among the `RULES` count as reported."""
    _reported.add((kind,))


def _told_of(kind: str, disc: Disc | None) -> tuple[object, ...]:
    """By what it is known that a doubt was told: a disc whose numbers vary, as in a sweep, is the
    one of which it was made."""
    if disc is None or kind not in OF_A_DISC:
        return (kind,)
    return (kind, *dict(disc.varied_from).values())


def warn_of_disc(disc: Disc) -> None:
    """Warn of implausible modes of a disc that was read from a file, and of the doubts of its
    report."""
    for text in disc.report.doubts if disc.report else ():
        _warn(text)
    for kind, doubt in DISC_RULES.items():
        if text := doubt(disc):
            _reported.add(_told_of(kind, disc))
            _warn(text)


def warn_without_effect(names: Sequence[str]) -> None:
    """Warn of columns of a table of samples, if any, that are no numbers of the case."""
    if names:
        are = "is no number" if len(names) == 1 else "are no numbers"
        kept = "kept beside the samples, without effect"
        _warn(f"{' and '.join(names)} {are} of the case: {kept}")


def warn_if(text: str) -> None:
    """Warn of an implausible value, unless the text is empty."""
    if text:
        _warn(text)


def _warn(text: str) -> None:
    """Warn of an implausible value."""
    warn_reader(text, ImplausibleValue)


def warn_reader(text: str, category: type[Warning]) -> None:
    """Warn at the line of the reader that called this package, however far above it is."""
    level = 1
    frame: FrameType | None = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] in INNER:
        frame = frame.f_back
        level += 1
    warnings.warn(text, category, stacklevel=level)


def _value(p: Parameters, name: str) -> str:
    return f"{name} = {getattr(p, name):g} {Parameters.unit(name)}".removesuffix(" 1")


def _far(name: str, usual: float, p: Parameters) -> str:
    value = abs(getattr(p, name))
    if usual / 100 <= value <= usual * 100 or value == 0:
        return ""
    how = "more than a hundred times" if value > usual else "less than a hundredth of"
    exceeded = (
        ", and event times are less accurate than tol says" if name == "k" and value > usual else ""
    )
    return f"{_value(p, name)} is {how} the {usual:g} of Table 1{exceeded}"


def _thick(p: Parameters) -> str:
    if p.h <= 0.2 * (p.b - p.a):
        return ""
    return f"{_value(p, 'h')} is more than a fifth of b - a = {p.b - p.a:g} m, and the disc is modelled as a thin plate"


def _short(p: Parameters) -> str:
    if _thick(p):  # which is told already
        return ""
    try:
        shortest = shortest_wave(p)
    except (DiscModelError, ArithmeticError):  # reported when the modes are requested
        return ""
    if shortest is None or not shortest.excess > TOO_HIGH:
        return ""
    mode = f"{counted(shortest.diameters, 'diameter')} and {counted(shortest.circles, 'circle')}"
    waves = f"the mode of {mode} has waves of {shortest.length:.2g} thicknesses"
    return f"{waves}, too short for a thin plate, whose frequency is {100 * shortest.excess:.0f} % too high"


def _deflected(p: Parameters) -> str:
    if p.disc is not None:  # its thickness is unknown
        return ""
    try:
        deflection = p.N * mode_arrays(p, "orthonormal").flexibility  # of the physical plate
    except (DiscModelError, ArithmeticError):  # reported when the modes are requested
        return ""
    # Linear theory holds up to about the thickness. The paper's cases have up to 8 times as much,
    # and 211 at the 80,000 N that prevent any motion; a mistake in units is a factor of 1000.
    if not 300 * p.h < deflection < math.inf:
        return ""
    times = f"{1e3 * deflection:.3g} mm, {deflection / p.h:.0f} times the thickness"
    return f"{_value(p, 'N')} bends the disc by {times}, and its theory is linear"


def _pitch(disc: Disc) -> str:
    lowest = min(disc.omega) / math.tau
    if 10.0 <= lowest <= 1e5 or _alone(disc) or _mixed(disc):  # Hz
        return ""
    text = f"the lowest mode of the disc has {lowest:.3g} Hz: "
    return f"{text}a table has frequencies in Hz or rad/s, by its column"


def _alone(disc: Disc) -> str:
    """One frequency a thousand times too low or too high to stand among the others."""
    frequencies = np.array(disc.omega) / math.tau
    if len(frequencies) < 3:
        return ""
    for i, frequency in enumerate(frequencies):
        others = np.delete(frequencies, i)
        if others.min() / APART < frequency < others.max() * APART:
            continue
        meant = frequency * (1000 if frequency < others.min() else 1e-3)
        if others.min() / 3 <= meant <= 3 * others.max():
            text = f"mode {i + 1} of the disc has {frequency:.4g} Hz, and the others "
            text += f"{others.min():.4g} to {others.max():.4g} Hz: "
            return f"{text}{meant:.4g} Hz, with another unit, would be among them"
    return ""


def _mixed(disc: Disc) -> str:
    """Two groups of frequencies that would be one if the lower ones were in kHz."""
    ordered = np.sort(disc.omega)
    if len(ordered) < 2 or _alone(disc):
        return ""
    gaps = ordered[1:] / ordered[:-1]
    widest = int(gaps.argmax())
    low, high = np.split(ordered, [widest + 1])
    if gaps[widest] < WIDE or 1000 * low[-1] < high[0] / 3 or 1000 * low[0] > 3 * high[-1]:
        return ""
    groups = f"{frequencies_text(low.tolist())} and {frequencies_text(high.tolist())}"
    text = f"frequencies of the disc lie far apart, {groups}: "
    return f"{text}some seem to be in kHz among others in Hz"


def _modal_mass(disc: Disc) -> str:
    largest = max(map(abs, disc.amplitude))
    if largest == 0 or 1e-3 <= largest**-2 <= 1e3:  # kg
        return ""
    return f"the largest amplitude of the disc, {largest:.3g} kg^-1/2, is that of a modal mass of {largest**-2:.2g} kg"


def _overdamped(disc: Disc) -> str:
    most = max(disc.damping_ratio)
    if most <= MOST_DAMPED:
        return ""
    doubted = sum(ratio > MOST_DAMPED for ratio in disc.damping_ratio)
    if doubted == 1:
        mode = disc.damping_ratio.index(most) + 1
        return f"mode {mode} of the disc has the {_damped(most)}"
    share = f"{doubted} of {counted(len(disc.damping_ratio), 'mode')} of the disc"
    return f"{share} have damping ratios of up to {most:.3g}, {_TOO_DAMPED}"


def _damped(ratio: float) -> str:
    """What is implausible of a damping ratio."""
    return f"damping ratio {ratio:.3g}, {_TOO_DAMPED}"


def _overdamped_plate(p: Parameters) -> str:
    ratio = p.damping_ratio
    if p.disc is not None or ratio is None or ratio <= MOST_DAMPED:
        return ""
    return f"the disc has the {_damped(ratio)}"


def _elsewhere(p: Parameters) -> str:
    if p.disc is None and not {"a", "b"} & p.model_fields_set:
        return ""
    if "r_0" not in p.model_fields_set:
        return f"{_value(p, 'r_0')} is the paper's: state where the slider runs on this disc"
    if p.disc is None or not p.disc.radii:
        return ""
    low, *_, high = p.disc.radii
    if not low <= p.r_0 <= high:
        return f"{_value(p, 'r_0')} is not within {low:g} to {high:g} m, where the disc's shapes are known"
    return _unlike_shapes(p, p.disc)


def _unlike_shapes(p: Parameters, disc: Disc) -> str:
    """What is implausible of amplitudes that are not those of the shapes at the slider."""
    by_shapes = shapes_at_slider(disc, p.r_0)
    doubted = np.flatnonzero(are_elsewhere(disc, by_shapes))
    if doubted.size == 0:
        return ""
    far = np.abs(by_shapes - disc.amplitude)[doubted]
    i = int(doubted[np.argmax(far)])
    text = f"{_value(p, 'r_0')} is not where the amplitudes of the disc were taken: "
    text += f"mode {i + 1} moves by {by_shapes[i]:.3g} kg^-1/2 there by its shape, "
    text += f"and its amplitude is {disc.amplitude[i]:.3g}"
    others = doubted.size - 1
    return f"{text}; {counted(others, 'other mode')} alike" if others else text


def _unstated(p: Parameters) -> str:
    changed = [name for name in MEASURES if getattr(p, name) != DEFAULTS[name]]
    needed = {"the normalization of modes ('orthonormal' for a real disc)": {"normalization"}}
    if changed != ["E"]:  # the paper varies E alone, with the damping of Table 1
        needed |= {"the damping (D_star or damping_ratio)": {"D_star", "damping_ratio"}}
    unstated = [text for text, names in needed.items() if p.model_fields_set.isdisjoint(names)]
    if p.disc is not None or not changed or not unstated:
        return ""
    return f"{_value(p, changed[0])} is not the paper's disc: state {' and '.join(unstated)}"


def _of_disc(doubt: Callable[[Disc], str], p: Parameters) -> str:
    """What a rule says of the disc of a case, "" if the case has a plate."""
    return "" if p.disc is None else doubt(p.disc)


# what each rule says of a disc that is given by its modes, "" if that is plausible
DISC_RULES: dict[str, Callable[[Disc], str]] = {
    "frequencies of the disc": _pitch,
    "a frequency of the disc": _alone,
    "units of frequencies": _mixed,
    "amplitudes of the disc": _modal_mass,
    "damping of the disc": _overdamped,
}

SLIDER = "radius of the slider"  # a rule
OF_A_DISC = (*DISC_RULES, SLIDER)  # rules that are told once for each disc

_MEASURED = ("D_star", "k", "k_p", "E", "m", "mu_s", "mu_k", "a", "b", "r_0", "h", "nu", "rho")
# what each rule says of a case, "" if that is plausible
RULES: dict[str, Callable[[Parameters], str]] = {
    **{name: partial(_far, name, DEFAULTS[name]) for name in _MEASURED},
    "thickness": _thick,
    "modes and damping": _unstated,
    "damping_ratio": _overdamped_plate,
    **{kind: partial(_of_disc, doubt) for kind, doubt in DISC_RULES.items()},
    SLIDER: _elsewhere,
    "short waves": _short,
    "static deflection": _deflected,
}
