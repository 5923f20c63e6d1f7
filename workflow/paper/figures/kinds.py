"""Kinds of the paper's figures: what a study file may say of them."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from disc_model.figures.kinds.base import (
    CasePlot,
    InTime,
    Kind,
    Need,
    Plot,
    Ranges,
    Role,
    Roles,
    Rule,
    Sampled,
    Samples,
    as_samples,
    as_spectrum,
)
from disc_model.simulation.case import Window
from disc_model.units import Finite, Positive, Unit

AROUND = 9  # windows at as many angles, from which the whole disc is made
WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")
LOOK = 0.2  # length of a closer look, s
STRETCH = 0.04  # of contact force in the composite, s


class ContactForce(CasePlot):
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""

    kind: Literal["paper.contact_force"] = "paper.contact_force"
    history: Ranges = "history"
    zoom: Samples = "zoom"


class OneSeparation(CasePlot):
    """(a) Displacements from static equilibrium around the first complete separation of a window,
    (b) the gap."""

    usual = "column"
    kind: Literal["paper.one_separation"] = "paper.one_separation"
    zoom: Samples = "zoom"


class LightSlider(CasePlot):
    """Displacements from static equilibrium in a part of a window, with the losses of contact."""

    usual = "column"
    kind: Literal["paper.light_slider"] = "paper.light_slider"
    zoom: Samples = "zoom"


class WithAndWithout(CasePlot):
    """Range of the disc at r_0 and a fixed angle over the run, with separation and, in the case
    `ignored`, without."""

    further = ("ignored",)
    usual = "column"
    kind: Literal["paper.with_and_without"] = "paper.with_and_without"
    ignored: str
    history: Ranges = "history"


class Histories(CasePlot):
    """Ranges of the contact force and of the disc at r_0 and a fixed angle, a column for each case,
    on common axes. A range of the force below a twentieth of the axis is drawn once more.

    until : end of the part of the runs that is shown
    printed : first separation of the last case that the paper prints
    """

    further = ("beside",)
    kind: Literal["paper.histories"] = "paper.histories"
    beside: tuple[str, ...] = ()
    history: Ranges = "history"
    until: Annotated[Positive, Unit("s")] | None = None
    printed: Annotated[Positive, Unit("s")] | None = None


class Instants(CasePlot):
    """The disc from above, and along its circle of radius r_0, at four instants from the first loss
    of contact to the next, or over the whole stretch without two losses, by nine windows `around0`,
    ..."""

    kind: Literal["paper.instants"] = "paper.instants"

    def needs(self) -> Iterator[Need]:
        for i in range(AROUND):
            yield Need("case", self.case, f"around{i}", as_samples)


class FourStretches(CasePlot):
    """Range of the disc at r_0 and a fixed angle, and its power over time and frequency in four
    stretches, with the lines of Table 2. The last row is the bilateral case `ignored`, which has
    the same windows but the first.

    until : end of the part of the run that is shown
    """

    widths = ("page",)
    further = ("ignored",)
    kind: Literal["paper.four_stretches"] = "paper.four_stretches"
    history: Ranges = "history"
    until: Annotated[Positive, Unit("s")] | None = None
    ignored: str

    def needs(self) -> Iterator[Need]:
        for need in super().needs():
            if need.case == self.case:
                yield need
        for name in WINDOWS:
            yield Need("case", self.case, name, as_spectrum)
        for name in WINDOWS[1:]:
            yield Need("ignored", self.ignored, name, as_spectrum)


class Response(CasePlot):
    """(a) Range over the run, with closer looks below it if there are any, (b) spectrum in time in
    a window.

    zooms : windows, and where looks begin, s
    highest : whether the disc's highest natural frequency is marked
    until : end of the part of the run that (a) shows
    ignored : the case with bilateral contact, whose spectrum is drawn below
    printed : time of the first separation that the paper prints
    """

    further = ("ignored",)
    kind: Literal["paper.response"] = "paper.response"
    variable: Sampled
    window: InTime
    history: Ranges = "history"
    zooms: Annotated[tuple[tuple[str, Finite], ...], Field(max_length=2)] = ()
    highest: bool = False
    until: Annotated[Positive, Unit("s")] | None = None
    ignored: str = ""
    printed: Annotated[Positive, Unit("s")] | None = None

    def needs(self) -> Iterator[Need]:
        for need in super().needs():
            if need.case == self.case or need.key == "window":
                yield need
        for name, start in self.zooms:
            yield Need("zooms", self.case, name, _contains(start, start + LOOK))


def _contains(start: float, stop: float) -> Rule:
    """The rule of a window of samples that has to contain a stretch, s."""

    def rule(window: Window) -> str:
        if not window.start <= start <= stop <= window.stop:
            return f"must contain {start:g} to {stop:g} s"
        return as_samples(window)

    return rule


class Schematic(CasePlot):
    """The model of a case, its radii to scale."""

    widths = ("page",)
    kind: Literal["paper.schematic"] = "paper.schematic"


class Composite(CasePlot):
    """The model, the disc's vibration with separation and, in the case `ignored`, bilateral, and
    the contact force.

    force : window of the contact force, and the time at which the stretch shown begins, s
    until : end of the part of the runs that is shown
    """

    further = ("ignored",)
    kind: Literal["paper.composite"] = "paper.composite"
    ignored: str
    history: Ranges = "history"
    force: tuple[str, Finite]
    until: Annotated[Positive, Unit("s")]

    def needs(self) -> Iterator[Need]:
        yield from super().needs()
        name, start = self.force
        yield Need("force", self.case, name, _contains(start, start + STRETCH))


class Scales(Plot):
    """(a) Squared amplitudes under the slider, (b) where the static start separates on the map over
    speed and preload, (c) first separations on this and further maps."""

    quantities: ClassVar = ("regions",)
    needs: ClassVar = ("N", "Omega")
    several: ClassVar = True
    roles: ClassVar[Roles] = {
        f"map_{name}": Role("regions", (other, name), required=True)
        for name, other in (("D_star", "Omega"), ("c_p", "N"), ("k_p", "Omega"), ("m", "Omega"))
    }
    kind: Literal["paper.scales"] = "paper.scales"


KINDS: dict[str, type[Kind]] = {
    "paper.composite": Composite,
    "paper.contact_force": ContactForce,
    "paper.four_stretches": FourStretches,
    "paper.histories": Histories,
    "paper.instants": Instants,
    "paper.light_slider": LightSlider,
    "paper.one_separation": OneSeparation,
    "paper.response": Response,
    "paper.scales": Scales,
    "paper.schematic": Schematic,
    "paper.with_and_without": WithAndWithout,
}
