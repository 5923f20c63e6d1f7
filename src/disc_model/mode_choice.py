"""How many modes a case needs: `choose_modes`. By a quantity of the motion it is the first model with
which two larger ones agree. A table is never compared with itself: whether all its modes are enough
is not known.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.disc.thin_plate import shortest_wave
from disc_model.display import Bar, Summarised, counted, number_text, progress_bar
from disc_model.errors import DiscModelError, Fault, raise_faults, require, with_known_names
from disc_model.mode_measures import (
    LACKING,
    MEASURES,
    SLIDING_GROWTH,
    growing_frequency,
    growing_modes,
    sliding_growth,
)
from disc_model.parameters import RESIDUAL, Disc, Parameters
from disc_model.units import Finite, Strict, Unit

FREQUENCIES = "frequencies"  # the quantity by which modes are chosen by default
# quantities by which modes may be chosen, and their default relative tolerances
CHOSEN_BY = {FREQUENCIES: 1e-3, "growth": 1e-2, SLIDING_GROWTH: 1e-2, "first_separation": 1e-2}
# Least tolerance, relative: the coupled frequencies of `RICH` change as much with more modes (5e-5 as
# published, 2e-4 orthonormal, against 30 diameters and 8 circles), and growth rates and times depend on
# the frequencies.
TRUSTED = 1e-4
RICH = (20, 6)  # diameters and circles of the reference model for frequencies
# diameters and circles of the candidates by a quantity of the motion: the last is compared with 99
# modes
CANDIDATES = ((1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (6, 1), (8, 1))
# further ones by the growth rate of steady sliding, which takes no simulation; the last is compared
# with 285 modes
LARGER = ((10, 1), (10, 2), (14, 2), (10, 3), (14, 3))
GIVEN_UP = (4, 0)  # the search ends here if no model so far, of up to 34 modes, has the quantity
MORE_MODES = "give a table with more modes, or a larger tolerance"
BAND = 2.0  # upper end of the band of compared frequencies, relative to the lowest frequency of the disc


class ModeRequest(Strict):
    """Quantity and tolerance for the choice of the number of modes, and the highest frequency of growing
    modes that are judged, Hz; `CHOSEN_BY` has the default tolerances."""

    quantity: Literal[*CHOSEN_BY] = FREQUENCIES  # type: ignore[valid-type]
    tolerance: Annotated[Finite, Field(ge=TRUSTED)] = CHOSEN_BY[FREQUENCIES]
    highest_frequency: Annotated[Finite, Field(gt=0), Unit("Hz")] | None = None

    @model_validator(mode="before")
    @classmethod
    def _with_tolerance(cls, values: dict[str, Any]) -> dict[str, Any]:
        tolerance = CHOSEN_BY.get(str(values.get("quantity")), CHOSEN_BY[FREQUENCIES])
        return {"tolerance": tolerance, **values}

    @model_validator(mode="after")
    def _of_sliding(self) -> Self:
        """A highest frequency is that of modes of steady sliding."""
        if self.highest_frequency is not None and self.quantity != SLIDING_GROWTH:
            rule = f"is used with quantity={SLIDING_GROWTH!r} only"
            raise_faults([Fault.of(("highest_frequency",), self.highest_frequency, rule)])
        return self


@dataclass(frozen=True)
class ModeChoice(Summarised):
    """The smallest model that meets a tolerance, and the basis of the choice.

    Attributes
    ----------
    parameters : the case with the chosen n_diameters and n_circles, or with the first modes of its table
    quantity : the quantity by which the modes were chosen
    tolerance, error : requested and reached, relative; of the coupled frequencies in the band, or of the quantity
    modes : number of real-valued modes; a pair, cosine and sine, counts as two
    rich : (diameters, circles) of the largest model in the comparison; (modes,) for a table
    values : the quantity for each model computed, by size as in `rich`; empty if the modes were chosen by frequencies
    growing : by the growth rate of steady sliding, how many modes grow with the chosen ones, and with those of `rich`;
        the quantity is the largest rate alone, and modes that were left out may grow as well
    frequencies : by the growth rate of steady sliding, that of the mode that grows fastest with each model, Hz
    highest_frequency : of the growing modes that were judged, Hz; None if all were
    """

    parameters: Parameters
    tolerance: float
    error: float
    modes: int
    rich: tuple[int, ...]
    quantity: str = FREQUENCIES
    values: Mapping[tuple[int, ...], float] = field(default_factory=dict)
    growing: tuple[int, int] | None = None
    frequencies: Mapping[tuple[int, ...], float] = field(default_factory=dict)
    highest_frequency: float | None = None

    def __repr__(self) -> str:
        p = self.parameters
        size = (p.n_diameters, p.n_circles) if p.disc is None else (len(p.disc.omega),)
        by = self.quantity
        if by != FREQUENCIES:  # which are those at rest
            by = f"{by} at {number_text(p.Omega, 'rad/s')}"
        counts = f"{self.size_text(size)} ({counted(self.modes, 'real mode')})"
        text = f"{counts}, by {by}, error {self.error:.2g}"
        if self.loses_growing:
            text += f"; {self._growing_text()}"
        return f"ModeChoice({text})"

    @property
    def loses_growing(self) -> bool:
        """Whether not so many modes grow as with the largest model that was compared."""
        return self.growing is not None and self.growing[0] < self.growing[1]

    def _growing_text(self) -> str:
        """How many modes grow with the largest model, and with the chosen one; "" if unknown."""
        if self.growing is None:
            return ""
        chosen, largest = self.growing
        all_modes = f"all {self.size_text(self.rich)}"
        if self.parameters.disc is None:
            all_modes = self.size_text(self.rich)
        grow = "grows" if largest == 1 else "grow"
        return f"with {all_modes} {largest} {grow}, with these {chosen}"

    def _summary(self) -> Iterator[tuple[str, object]]:
        p = self.parameters
        if p.disc is None:
            yield "n_diameters", p.n_diameters
            yield "n_circles", p.n_circles
        yield "modes", f"{self.modes}, a pair counts as two"
        yield "chosen by", self.quantity
        if self.quantity != FREQUENCIES:
            yield "at", f"{p.Omega:g} rad/s, {p.N:g} N; other speeds may need more modes"
        if self.highest_frequency is not None:
            yield "modes judged", f"up to {_frequency_text(self.highest_frequency)}"
        yield "error", f"{self.error:.2g}, relative; {self.tolerance:g} was asked for"
        yield "largest model compared", self.size_text(self.rich)
        yield "modes that grow", self._growing_text()
        shortest = shortest_wave(p)
        if shortest is not None:
            waves = f"waves of {shortest.length:.3g} thicknesses"
            yield (
                "highest mode",
                f"{waves}, frequency of a thin plate {100 * shortest.excess:.2g} % too high",
            )
        for size, value in self.values.items():
            text = f"{value:.6g}{_at_frequency(self.frequencies, size)}"
            yield f"{self.quantity} with {self.size_text(size)}", text

    @staticmethod
    def size_text(size: tuple[int, ...]) -> str:
        """The size of a model in words."""
        if len(size) == 1:
            return counted(size[0], "mode")
        return f"{counted(size[0], 'diameter')}, {counted(size[1], 'circle')}"


class UndecidedModes(DiscModelError):
    """No number of modes could be chosen; the message says why, and a note below it has the table of `values`.

    Attributes
    ----------
    values : what was looked at for each model computed, by size as in `ModeChoice`: the quantity, or the relative error
        of the coupled frequencies
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.values: Mapping[tuple[int, ...], float] = {}

    @classmethod
    def after(
        cls,
        p: Parameters,
        what: str,
        values: Mapping[tuple[int, ...], float],
        reason: str,
        frequencies: Mapping[tuple[int, ...], float] | None = None,
    ) -> UndecidedModes:
        """The error with the values of a quantity, and a note of them in words; with the frequencies of
        modes that grow fastest, if the quantity has any."""
        error = cls(f"n_diameters: undecided: {reason}")
        error.values = values
        for size, value in values.items():
            modes = counted(count_modes(p, size), "real mode")
            text = f"{value:.6g}{_at_frequency(frequencies or {}, size)}"
            error.add_note(f"{what} with {ModeChoice.size_text(size)} ({modes}): {text}")
        return error


def _at_frequency(frequencies: Mapping[tuple[int, ...], float], size: tuple[int, ...]) -> str:
    """At what frequency a model grows fastest, after its growth rate; "" if that is unknown."""
    frequency = frequencies.get(size, np.nan)
    return "" if np.isnan(frequency) else f" at {_frequency_text(frequency)}"


def _frequency_text(frequency: float) -> str:
    """A frequency in Hz with its unit, in kHz from 1 kHz on."""
    return f"{frequency:.4g} Hz" if frequency < 1e3 else f"{frequency / 1e3:.4g} kHz"


def by_frequencies(p: Parameters, tolerance: float) -> ModeChoice:
    """Find the model with the fewest real modes whose `frequency_error` is within ``tolerance``."""
    sizes: Sequence[tuple[int, ...]]
    if p.disc is None:
        p = resized(p, RICH)
        every = product(range(RICH[0] + 1), range(RICH[1] + 1))
        sizes = sorted(every, key=lambda size: (count_modes(p, size), size[1]))
    else:
        sizes = [(count,) for count in counts(p.disc)]
    rich = sizes[-1]
    modes = mode_arrays(p)
    right = coupled_frequencies(p, contact_compliance(p))
    top = BAND * float(modes.omega.min())
    errors: dict[tuple[int, ...], float] = {}
    for size in sizes[:-1]:
        chosen = resized(p, size)
        frequencies = coupled_frequencies(p, contact_compliance(chosen), _modes_within(p, size))
        error = _worst(frequencies, right, top)
        errors[size] = error
        if error <= tolerance:
            return ModeChoice(chosen, tolerance, error, count_modes(p, size), rich)
    reason = (
        f"no model up to {RICH} (diameters, circles) meets {tolerance:g}; enlarge the tolerance"
    )
    if p.disc is not None:
        reason = _too_few_modes(p.disc)
    raise UndecidedModes.after(p, "error of frequencies", errors, reason)


def _too_few_modes(disc: Disc) -> str:
    """Why no first modes of a table can be chosen by frequencies."""
    return (
        f"no fewer than all {counted(len(disc.omega), 'mode')} of the "
        f"table have these frequencies, and whether all are enough is not known; {MORE_MODES}"
    )


def _modes_within(p: Parameters, size: tuple[int, ...]) -> slice | np.ndarray:
    """The modes of a case that are those of a size, as an index of arrays."""
    if p.disc is not None:
        return slice(*size)
    modes = mode_arrays(p)
    diameters, circles = size
    return (modes.diameters <= diameters) & (modes.circles <= circles)


def counts(disc: Disc) -> range:
    """Possible numbers of first modes of a table: at least one of these modes must move under the
    slider."""
    return range(1 + next(i for i, each in enumerate(disc.amplitude) if each), len(disc.omega) + 1)


def resized(p: Parameters, size: tuple[int, ...]) -> Parameters:
    """The case with the modes of a size: up to these diameters and circles, or so many first modes
    of its table."""
    if p.disc is not None:
        return p.replace(disc=p.disc.first(*size))
    return p.replace(n_diameters=size[0], n_circles=size[1])


def count_modes(p: Parameters, size: tuple[int, ...]) -> int:
    """Number of real modes of `resized`: pairs count as two."""
    if p.disc is None:
        return real_modes(*size)
    return size[0] + sum(l > 0 for l in p.disc.diameters[: size[0]])


def frequency_error(p: Parameters, rich: Parameters) -> float:
    """Largest relative error, against `rich`, of the coupled frequencies up to `BAND` times the
    disc's lowest one."""
    mine, right = (coupled_frequencies(case, contact_compliance(case)) for case in (p, rich))
    return _worst(mine, right, BAND * float(mode_arrays(rich).omega.min()))


def _worst(mine: np.ndarray, right: np.ndarray, top: float) -> float:
    """Largest relative error of frequencies up to ``top``; 1 if one is missing."""
    right = right[right <= top]
    if mine.size < right.size:
        return 1.0
    return min(1.0, float(np.max(np.abs(mine[: right.size] / right - 1.0), initial=0.0)))


def real_modes(diameters: int, circles: int) -> int:
    """Number of real modes of a model: pairs count as two."""
    return (circles + 1) * (2 * diameters + 1)


@with_known_names
def choose_modes(
    case: Parameters | Mapping[str, object],
    tolerance: float | None = None,
    *,
    quantity: str = FREQUENCIES,
    highest_frequency: float | str | None = None,
    progress: bool = False,
) -> ModeChoice:
    """Find the fewest real-valued modes with which a quantity's error is within ``tolerance``.

    A quantity of the motion is that of the case's own speed and preload. More modes may take part at higher
    speeds, so choose at the highest speed of interest.

    Parameters
    ----------
    case : `Parameters`, or a mapping of their values; n_diameters and n_circles are ignored.  With
        ``contact_compliance="residual"`` each model has the flexibility of the modes that it leaves out
    tolerance : relative, at least 1e-4; None is 1e-3 for frequencies, 1e-2 for the growth rate and the first
        separation
    quantity : "frequencies", the coupled frequencies of disc and slider at rest up to twice the lowest one of the disc,
        compared with those of 20 diameters and 6 circles; "growth", the growth rate of the stick-slip cycle;
        "sliding_growth", that of steady sliding; "first_separation", its time within 600 s.  "growth" and
        "first_separation" need simulations. Modes of a table are compared with the whole table
    highest_frequency : Hz, or with a unit, such as "20 kHz": by "sliding_growth", of the growing modes that are judged;
        others may grow faster, but a thin plate is wrong at high frequencies. None is no limit
    progress : whether a bar on standard error counts the models that are done, with a quantity of the motion; if
        not, a line there names this argument after 10 s

    Returns
    -------
    ModeChoice
        Its `parameters` are the case with the modes that were chosen.

    Raises
    ------
    ParameterError
        If a value of the case breaks a rule, the quantity is unknown, or the tolerance is below 1e-4.
    disc_model.mode_choice.UndecidedModes
        If no model meets the tolerance or agrees with two larger ones, or there is no cycle, separation or steady
        sliding to choose by; and if a table has too few modes to tell. Its `values` are those of all models that were
        computed. Where friction acts on the surface at a point, motions do not converge: the message then asks for the
        arc of a pad. By the growth rate of steady sliding it has the frequency of the mode that grows fastest with each
        model.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.choose_modes({"N": 385, "Omega": 15.1}, 1e-3).parameters.n_diameters
    3
    """
    asked = {"tolerance": tolerance, "highest_frequency": highest_frequency}
    given = {name: value for name, value in asked.items() if value is not None}
    request = ModeRequest.model_validate({"quantity": quantity, **given})
    known = isinstance(case, Parameters | Mapping)
    told = isinstance(progress, bool)
    require(
        (known, "case", case, "must be Parameters, or a mapping of names to values"),
        (told, "progress", progress, "must be True or False"),
    )
    if not isinstance(case, Parameters):
        sizes = ("n_diameters", "n_circles")
        case = Parameters.model_validate({name: x for name, x in case.items() if name not in sizes})
    with progress_bar("choose_modes", None, progress) as bar:
        return chosen_modes(case, request, bar)


def chosen_modes(p: Parameters, request: ModeRequest, bar: Bar | None = None) -> ModeChoice:
    """The requested choice, whose models a bar counts; raises `UndecidedModes` if there is none."""
    bar = bar or Bar(None)
    if request.quantity == FREQUENCIES:
        return by_frequencies(p, request.tolerance)
    found = _Measured(p, request)
    values = found.values
    for group in _compared(p, request.quantity):
        size = group[0]
        for each in group:
            found.measure(each, bar)
        if (p.disc is not None or size == GIVEN_UP) and all(map(np.isnan, values.values())):
            reason = f"no {request.quantity} to choose by with {_listed(p, group)}"
            raise UndecidedModes.after(p, request.quantity, values, reason)
        change = found.change(group)
        if change <= request.tolerance:
            return ModeChoice(
                parameters=resized(p, size),
                tolerance=request.tolerance,
                error=change,
                modes=count_modes(p, size),
                rich=group[-1],
                quantity=request.quantity,
                values=values,
                growing=found.growing(size, group[-1]),
                frequencies=found.frequencies,
                highest_frequency=request.highest_frequency,
            )
    reason = f"{_why_undecided(found, group)}; {_advice(found, group)}"
    raise UndecidedModes.after(p, request.quantity, values, reason, found.frequencies)


@dataclass
class _Measured:
    """What was measured of models of a case: values of the quantity, and where it is the growth rate of
    steady sliding, the frequencies of the modes that grow fastest, Hz."""

    p: Parameters
    request: ModeRequest
    values: dict[tuple[int, ...], float] = field(default_factory=dict)
    frequencies: dict[tuple[int, ...], float] = field(default_factory=dict)

    @property
    def highest(self) -> float:
        """The highest frequency of the modes that are judged, Hz."""
        limit = self.request.highest_frequency
        return np.inf if limit is None else limit

    def measure(self, size: tuple[int, ...], bar: Bar) -> None:
        """Measure a model, unless that is done, and count it."""
        if size in self.values:
            return
        bar.describe(f"choose_modes: {counted(count_modes(self.p, size), 'mode')}")
        case = resized(self.p, size)
        if self.request.quantity == SLIDING_GROWTH:
            self.values[size] = sliding_growth(case, self.highest)
            self.frequencies[size] = growing_frequency(case, self.highest)
        else:
            self.values[size] = MEASURES[self.request.quantity](case)
        bar.advance()

    def growing(self, size: tuple[int, ...], rich: tuple[int, ...]) -> tuple[int, int] | None:
        """How many modes of steady sliding grow with two sizes; None for other quantities."""
        if self.request.quantity != SLIDING_GROWTH:
            return None
        chosen, largest = (
            growing_modes(resized(self.p, each), self.highest) for each in (size, rich)
        )
        return chosen, largest

    def change(self, group: Sequence[tuple[int, ...]]) -> float:
        """The largest change of the quantity from the first model of a group to the others."""
        size, *others = group
        return max(_change(self.values[size], self.values[other]) for other in others)


def _why_undecided(found: _Measured, group: tuple[tuple[int, ...], ...]) -> str:
    """How the quantity of the last models that were compared still changes."""
    p = found.p
    request = found.request
    values = found.values
    missing = [each for each in group if np.isnan(values[each])]
    lacking = LACKING[request.quantity]
    if len(missing) == len(group):
        return f"models of {_listed(p, group)} have no {lacking}, and others do"
    if missing:
        return f"some models have a {lacking} and others none, among {_listed(p, group)}"
    change = found.change(group)
    by = f"by {change:.2g} of itself" if np.isfinite(change) else "from zero"
    changes = f"changes {by} among {_listed(p, group)}"
    if found.frequencies:
        rates = (f"{values[each]:.3g}/s{_at_frequency(found.frequencies, each)}" for each in group)
        changes = f"{changes} ({', '.join(rates)})"
    return f"{request.quantity} still {changes}, more than {request.tolerance:g}"


def _advice(found: _Measured, group: tuple[tuple[int, ...], ...]) -> str:
    """What to do where a quantity changes with the number of modes."""
    p = found.p
    if p.friction_offset != 0 and p.contact_arc == 0:
        return (
            "friction on the surface at a point excites modes of any number of nodal diameters, "
            "and the motion does not converge: give contact_arc, the arc of the pad"
        )
    if p.disc is not None:
        ways = ["a table with more modes", _enough(found.change(group))]
    else:
        ways = ["the number of modes", _enough(found.change(group))]
        if p.contact_compliance != RESIDUAL:
            ways.append(f"contact_compliance={RESIDUAL!r}")
    if found.request.quantity == SLIDING_GROWTH:
        ways.append("highest_frequency, up to which growing modes are judged")
    return f"give {', '.join(ways[:-1])}, or {ways[-1]}"


def _enough(change: float) -> str:
    """The tolerance, in two digits, with which a change would do."""
    if not np.isfinite(change):
        return "a larger tolerance"
    unit = 10.0 ** (np.floor(np.log10(change)) - 1)
    return f"a tolerance of {np.ceil(change / unit) * unit:.2g}"


def _compared(p: Parameters, quantity: str) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Candidates, each with the larger models for comparison: of a table, twice as many modes, and
    all of them."""
    if p.disc is None:
        candidates = [*CANDIDATES]
        if quantity == SLIDING_GROWTH:
            candidates += LARGER
        yield from (((l, c), (2 * l, c), (2 * l, c + 1)) for l, c in candidates)
        return
    most = counts(p.disc)[-1]
    count = counts(p.disc)[0]
    if count == most:
        reason = f"only one mode of the table moves at the slider; {MORE_MODES}"
        raise UndecidedModes.after(p, quantity, {}, reason)
    while count < most:
        yield tuple(dict.fromkeys([(count,), (min(2 * count, most),), (most,)]))
        count += (count + 1) // 2


def _change(mine: float, other: float) -> float:
    """Change relative to the larger model; infinite if the quantity is missing in one model or in
    both."""
    if mine == other:
        return 0.0
    if np.isfinite(mine) and np.isfinite(other) and other:
        return abs(mine / other - 1.0)
    return np.inf


def _listed(p: Parameters, sizes: tuple[tuple[int, ...], ...]) -> str:
    """Numbers of modes that were compared: rows of a table, or real modes of the plate."""
    if p.disc is not None:
        return " and ".join(str(size[0]) for size in sizes) + " modes of the table"
    return ", ".join(str(count_modes(p, size)) for size in sizes) + " modes"
