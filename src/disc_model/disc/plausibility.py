"""Warnings of values that are allowed but implausible, such as E = 150, which was probably meant in GPa."""

import math
import sys
import warnings
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from disc_model.parameters import Parameters


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


class Rule(NamedTuple):
    names: tuple[str, ...]  # the parameters that it reads
    doubt: Callable[[Parameters], str]  # its message about a case, "" if that is plausible


def doubts(p: Parameters) -> dict[str, str]:
    """Messages on implausible values of a case, by the rule that gives them."""
    return {kind: text for kind, rule in RULES.items() if (text := rule.doubt(p))}


def _warn(text: str) -> None:
    """Warn with the line that called this package, however deep in it the case is looked at."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals["__name__"].startswith(("disc_model.", "contextlib")):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, ImplausibleValue, stacklevel=level)


_reported: set[str] = set()


def warn_of_doubts(p: Parameters, tell: Callable[[str], object] = _warn) -> None:
    """Report implausible values of a case, once in a process by each rule; by default as a warning."""
    for kind, text in doubts(p).items():
        if kind not in _reported:
            _reported.add(kind)
            tell(text)


def _value(p: Parameters, name: str) -> str:
    return f"{name} = {getattr(p, name):g} {Parameters.unit(name)}".removesuffix(" 1")


def _far(name: str, usual: float, p: Parameters) -> str:
    value = abs(getattr(p, name))
    if usual / 100 <= value <= usual * 100 or value == 0:
        return ""
    how = "more than a hundred times" if value > usual else "less than a hundredth of"
    exceeded = ", and event times are less accurate than tol says" if name == "k" and value > usual else ""
    return f"{_value(p, name)} is {how} the {usual:g} of Table 1{exceeded}"


def _thick(p: Parameters) -> str:
    if p.h <= 0.2 * (p.b - p.a):
        return ""
    return f"{_value(p, 'h')} is more than a fifth of b - a = {p.b - p.a:g} m, and the disc is modelled as a thin plate"


def _sound(p: Parameters) -> str:
    speed = math.sqrt(p.E / p.rho)  # of sound along a rod: lead has 1,150 m/s, beryllium 12,600 and diamond 17,500
    if 1e3 <= speed <= 2e4:
        return ""
    made = f"{_value(p, 'E')} and {_value(p, 'rho')} make sqrt(E/rho) = {speed:.3g} m/s"
    return f"{made}, and solids have 1000 to 20000 m/s"


def _pitch(p: Parameters) -> str:
    if p.disc is None or 10.0 <= (lowest := min(p.disc.omega) / math.tau) <= 1e5:  # Hz
        return ""
    return f"the lowest mode of the disc has {lowest:.3g} Hz: a table has frequencies in Hz or rad/s, by its column"


def _elsewhere(p: Parameters) -> str:
    if p.disc is None and not {"a", "b"} & p.model_fields_set:
        return ""
    if "r_0" not in p.model_fields_set:
        return f"{_value(p, 'r_0')} is the paper's: state where the slider runs on this disc"
    if p.disc is None or not p.disc.radii:
        return ""
    low, *_, high = p.disc.radii
    if low <= p.r_0 <= high:
        return ""
    return f"{_value(p, 'r_0')} is not within {low:g} to {high:g} m, where the disc's shapes are known"


def _unstated(p: Parameters) -> str:
    changed = [name for name in _MATERIAL if getattr(p, name) != Parameters.model_fields[name].default]
    needed = {"the normalization of modes ('orthonormal' for a real disc)": {"normalization"}}
    if changed != ["E"]:  # the paper varies E alone, with the damping of Table 1
        needed |= {"the damping (D_star or damping_ratio)": {"D_star", "damping_ratio"}}
    unstated = [text for text, names in needed.items() if p.model_fields_set.isdisjoint(names)]
    if p.disc is not None or not changed or not unstated:
        return ""
    return f"{_value(p, changed[0])} is not the paper's disc: state {' and '.join(unstated)}"


_MATERIAL = ("a", "b", "h", "E", "nu", "rho")
RULES = {
    name: Rule((name,), partial(_far, name, Parameters.model_fields[name].default))
    for name in ("D_star", "k", "k_p", "E", "m", "mu_s", "mu_k", "a", "b", "r_0", "h", "nu", "rho")
} | {
    "thickness": Rule(("h", "a", "b"), _thick),
    "modes and damping": Rule((*_MATERIAL, "normalization", "D_star", "damping_ratio"), _unstated),
    "speed of sound": Rule(("E", "rho"), _sound),
    "frequencies of the disc": Rule(("disc",), _pitch),
    "radius of the slider": Rule(("disc", "r_0", "a", "b"), _elsewhere),
}
