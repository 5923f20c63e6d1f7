"""Special points of a branch, at which the number or the stability of cycles changes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from disc_model.arrays import Array
from disc_model.data.variables import values_text
from disc_model.display import Summarised, number_text
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.continuation.data import StoredBranch, stored_extremes
from disc_model.stability.continuation.special_kinds import CHANGES, LABELS
from disc_model.stability.return_map import ReturnMap
from disc_model.stability.segments import Extremes, extremes_of_cycle

NEUTRAL = 1e-6  # logarithm of a multiplier's modulus that counts as 0 at such a point


@dataclass(frozen=True, eq=False, repr=False)
class SpecialPoint(Summarised):
    """A point of a branch at which the number or the stability of cycles changes, or its end.

    Attributes
    ----------
    kind : "fold", two cycles meet; "period_doubling", a multiplier is -1; "neimark_sacker", a complex pair of
        multipliers has modulus one; "grazing", a switch is touched, and an event appears or vanishes; "hopf", the
        cycle shrinks to steady sliding; "branch_point", another branch crosses; "end", of the branch;
        "max_points", its end for no other reason than the number of points; "lost", its end where no step succeeds
    values : shape (n_parameters,), SI units
    period : s; stick_fraction; growth_rate : 1/s
    multiplier : the one that is critical; at a grazing and at an end, the leading one
    after : number of the point of the branch before it, or at it
    case : with the values of this point
    modal : (n,), modal coordinates on the section, in SI units
    make_map : makes the return map to that section
    """

    kind: str
    values: Array
    period: float
    stick_fraction: float
    growth_rate: float
    multiplier: complex
    after: int
    case: Parameters
    modal: Array = field(repr=False)
    make_map: type[ReturnMap] = ReturnMap

    @property
    def label(self) -> str:
        """Label of the kind in AUTO and COCO: LP, PD, TR, BP, HB, EP; GR."""
        return LABELS[self.kind]

    @property
    def changes_stability(self) -> bool:
        """Whether the cycle gains or loses stability here: no multiplier but the critical one is
        on the unit circle or beyond it."""
        neutral = abs(self.growth_rate * self.period) <= NEUTRAL
        return self.kind in CHANGES and neutral

    @cached_property
    def point(self) -> Array:
        """The cycle's point of the section, (n,), in the coordinates of its own return map."""
        return self.modal * self.make_map(self.case).scale

    @cached_property
    def state(self) -> State:
        """The cycle's state on the section, at the end of stick or, without stick, where the spring
        is longest, at time 0."""
        return self.make_map(self.case).state(self.point)

    @cached_property
    def _extremes(self) -> Extremes:
        """Extremes of the slider's height over a period of the cycle."""
        return extremes_of_cycle(self.case, self.state, self.period)

    @property
    def u_min(self) -> float:
        """Least height of the slider over static equilibrium in a period of the cycle, m; simulated
        when it, `u_max` or `range` is asked for."""
        return self._extremes.u_min

    @property
    def u_max(self) -> float:
        """Greatest height of the slider over static equilibrium in a period of the cycle, m."""
        return self._extremes.u_max

    @property
    def range(self) -> float:
        """Range of the slider's height over a period of the cycle, m."""
        return self._extremes.range

    def __repr__(self) -> str:
        values = ", ".join(f"{value:.9g}" for value in self.values)
        return f"SpecialPoint({self.kind} at {values}, period {self.period:.6g} s)"

    def _summary(self) -> Iterator[tuple[str, object]]:
        yield "kind", f"{self.kind} ({self.label})"
        yield "values", ", ".join(f"{value:.9g}" for value in self.values)
        yield "case", values_text(dict(self.case))
        yield "period", number_text(self.period, "s", 9)
        yield "growth rate", number_text(self.growth_rate, "1/s")
        yield "share of stick", number_text(self.stick_fraction, "", 3)
        yield "multiplier", f"{self.multiplier:.6g}, modulus {abs(self.multiplier):.9g}"
        yield "stability", "changes" if self.changes_stability else ""


def stored_special_points(stored: StoredBranch) -> tuple[SpecialPoint, ...]:
    """The special points of a branch's dataset."""
    data = stored.data
    points = []
    modal = stored.modal("special_")
    extremes = stored_extremes(data, "special_")
    for i, values in enumerate(stored.values("special_")):
        point = SpecialPoint(
            kind=str(data["special_kind"].values[i]),
            values=values,
            period=float(data["special_period"].values[i]),
            stick_fraction=float(data["special_stick_fraction"].values[i]),
            growth_rate=float(data["special_growth_rate"].values[i]),
            multiplier=complex(data["special_multiplier"].values[i]),
            after=int(data["special_after"].values[i]),
            case=stored.case_at(values),
            modal=modal[i],
            make_map=stored.make_map,
        )
        vars(point)["_extremes"] = Extremes(*extremes[i].tolist())
        points.append(point)
    return tuple(points)
