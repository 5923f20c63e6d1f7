"""Kinds that show motions, outcomes and modes over a parameter."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from disc_model.data.variables import SAMPLE
from disc_model.errors import Fault, suggestion
from disc_model.figures.kinds.base import NORM, Compared, Names, Plot, Role, Roles, Values, unknown
from disc_model.units import Finite, Positive, Real, Unit

ENERGY = "energy"  # of kicks, along which basins are drawn for each value of a parameter
MOST_PANELS = 6  # of these values
MOST_POINTS = 4  # greatest number of points that a figure of sensitivity shows


class Bifurcation(Plot):
    """The angle ψ once a turn against a parameter, and after how many switches the motion repeats.

    paper_cases : values of x by the paper's name of the case
    """

    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}
    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    paper_cases: Annotated[dict[str, Finite], Unit(of="x")] = Field({})


class Branches(Plot):
    """Range of motion of all cycles found against one parameter, stable and unstable, and where a
    sweep jumps.

    paper_cases : values of the parameter by the paper's name of the case
    """

    kind: Literal["branches"] = "branches"
    paper_cases: dict[str, Finite] = Field({})


class LateRange(Plot):
    """Peak-to-peak displacement of the slider against the speed, with separation and with it
    ignored.

    For discs whose surface moves, there are lines where contact is lost, and panels of the speed of
    the surface, with a line where it reaches that of the drive.

    by : dimension with a panel for each value
    thickness : of the disc, m; that of the paper unless given
    names : words for values of `by`
    """

    quantities = ("outcome",)
    kind: Literal["late_range"] = "late_range"
    by: str = "disc"
    thickness: Positive = 0.002
    names: Names = Field({})

    @property
    def dims(self) -> tuple[str, ...]:
        return ("Omega", "N", "contact", self.by)

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        yield from unknown("names", self.names, self.by, values.get(self.by, ()))


class EscapeShares(Plot):
    """Share of starts that have separated against time, a line for each value of a parameter.

    starts : dimension of the starts
    by : dimension with a line for each value
    """

    quantities = ("outcome",)
    kind: Literal["escape"] = "escape"
    starts: str = "perturbation_u"
    by: str = "N"

    @property
    def dims(self) -> tuple[str, ...]:
        return (self.starts, self.by)


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a
    parameter; or outcomes against the energy alone, with a panel for each value of the parameter.

    x : the parameter, or energy
    by : the parameter with a panel for each value, over the energy
    names : words for values of `by`
    """

    kind: Literal["basins"] = "basins"
    x: str
    by: str | None = None
    names: Names = Field({})

    @property
    def axes(self) -> dict[str, str]:
        """The parameter that the study varies, by the key that names it."""
        if self.x != ENERGY:
            return {"x": self.x}
        return {} if self.by is None else {"by": self.by}

    def wrong_axes(self, values: Values, shown: str) -> Iterator[Fault]:
        varied = [name for name in values if len(values[name]) > 1]
        if self.x == ENERGY and self.by is None and varied:
            yield Fault(("by",), "", f"is required over the energy, such as {varied[0]}")
            return
        if self.x != ENERGY and self.by is not None:
            yield Fault.of(("by",), self.by, f"must be left out, unless x is {ENERGY}")
            return
        yield from super().wrong_axes(values, shown)
        along = values.get(self.by or "", ())
        if len(along) > MOST_PANELS:
            rule = f"has {len(along)} values, and there is room for {MOST_PANELS}"
            yield Fault.of(("by",), self.by, rule)
        yield from unknown("names", self.names, self.by or "by", along)


class Staircase(Plot):
    """Number of separations per release of stick against a parameter, a step for each period.

    zooms : ends of parts of the axis that are shown enlarged, each within the one before
    """

    roles: ClassVar[Roles] = {"fine": Role("locking"), "slipping": Role("locking")}
    quantities = ("locking",)
    kind: Literal["staircase"] = "staircase"
    x: str
    zooms: Annotated[tuple[tuple[Finite, Finite], ...], Field(max_length=3)] = ()

    def wrong_axes(self, values: Values, shown: str) -> Iterator[Fault]:
        yield from super().wrong_axes(values, shown)
        for low, high in self.zooms:
            if not low < high:
                yield Fault.of(("zooms",), (low, high), "must be two ascending values of x")


class PhaseMap(Plot):
    """The map from the phase of a release to that of the next one, at a single point."""

    quantities = ("locking",)
    kind: Literal["phase_map"] = "phase_map"

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        if math.prod(len(along) for along in values.values()) > 1:
            yield Fault.of(("kind",), self.kind, "can show a study of one point only")


class RangeLawPlot(Plot):
    """Range of all motions of a study that separate, against the range at which their vibration
    loses contact.

    share : least share of height and contact force at one frequency of a motion with a filled mark
    set_apart : values of a parameter, by the name of its motions, which have marks of their own
    """

    several = True
    kind: Literal["range_law"] = "range_law"
    share: Annotated[Positive, Field(le=1)] = 0.95
    set_apart: dict[str, dict[str, Finite]] = Field({})

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Names that do not vary; whatever does, motions are drawn."""
        for group in self.set_apart.values():
            for name in group:
                # the name of a zip has those of all its parameters
                if not any(f"_{name}_" in f"_{dim}_" for dim in values):
                    yield Fault.of(("set_apart",), name, "does not vary in this study")


class Sensitivity(Plot):
    """Probability of instability in the lowest and in the highest third of each parameter; for up
    to four points."""

    several = True
    kind: Literal["sensitivity"] = "sensitivity"

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_POINTS:
            rule = f"has room for {MOST_POINTS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)


class Campbell(Compared):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the
    stick-slip frequency.

    normalization : the one shown, where the study has several
    highest : Hz, upper end of the axis of frequencies; without it, that of the modes
    multiples : whole numbers or halves, such as [2, 2.5]: these multiples of the stick-slip frequency are drawn over
        all speeds, with marks where modes cross them; without it, only those at the highest peaks of growth
    """

    needs = ("Omega",)
    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = None
    highest: Annotated[Positive, Unit("Hz")] | None = None
    multiples: tuple[Annotated[Real, Field(ge=0.5, le=1000, multiple_of=0.5)], ...] = ()

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        chosen = self.normalization
        yield from super().wrong_dims(values if chosen is None else {**values, NORM: ()})
        known = values.get(NORM, ())
        if chosen is not None and known and chosen not in known:
            yield Fault.of((NORM,), chosen, f"is not computed{suggestion(chosen, known)}")


class SlidingModes(Compared):
    """Frequencies and growth rates of steady sliding's modes along a parameter; where two meet,
    they coalesce."""

    quantities = ("sliding",)
    kind: Literal["sliding_modes"] = "sliding_modes"
    highest: Annotated[Positive, Unit("Hz")] | None = None
