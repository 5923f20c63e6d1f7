"""What a grid study may say about its figures. Imports nothing heavy: studies are checked against it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from disc_model.parameters import Real
from disc_model.studies.faults import Strict

Number = Annotated[Real, Field(allow_inf_nan=False)]


class Plot(Strict):
    """A figure of a grid study.

    others : further studies it shows, by the role they play in it
    """

    kind: str
    title: str = ""
    others: dict[str, str] = Field({})

    @property
    def quantity(self) -> str:
        """The quantity it shows."""
        raise NotImplementedError

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions that it needs."""
        return ()

    @property
    def module(self) -> str:
        """Module that draws it: ``draw(study, others, plot)`` with datasets and this."""
        raise NotImplementedError


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Number
    y: Number
    paper: Literal["stable", "unstable", "separation"]


class StabilityMap(Plot):
    """What becomes of the published start over two parameters, one panel for each normalization."""

    kind: Literal["stability_map"] = "stability_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @property
    def quantity(self) -> str:
        return "outcome"

    @property
    def dims(self) -> tuple[str, ...]:
        return (self.x, self.y)

    @property
    def module(self) -> str:
        return "disc_model.figures.maps"


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    kind: Literal["critical_speed"] = "critical_speed"
    claim: dict[str, tuple[Number, Number]] = Field({})

    @property
    def quantity(self) -> str:
        return "critical_speed"

    @property
    def dims(self) -> tuple[str, ...]:
        return ("N",)

    @property
    def module(self) -> str:
        return "disc_model.figures.curves"


class Thresholds(CriticalSpeed):
    """Where the cycle becomes unstable and where separation follows, on one chart."""

    kind: Literal["thresholds"] = "thresholds"  # type: ignore[assignment]

    @property
    def module(self) -> str:
        return "disc_model.figures.thresholds"


class GrowthMap(Plot):
    """Growth rate of the stick-slip cycle over speed and preload, a panel for each normalization."""

    kind: Literal["growth_map"] = "growth_map"

    @property
    def quantity(self) -> str:
        return "floquet"

    @property
    def dims(self) -> tuple[str, ...]:
        return ("N", "Omega", "normalization")

    @property
    def module(self) -> str:
        return "disc_model.figures.thresholds"


class Bifurcation(Plot):
    """Samples once a turn against a parameter.

    scale : of the variable, 1e3 for mrad or mm
    """

    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    variable: Literal["psi", "psi_velocity", "P", "u", "w_point"] = "psi"
    scale: Number = 1.0e3

    @property
    def quantity(self) -> str:
        return "bifurcation"

    @property
    def dims(self) -> tuple[str, ...]:
        return (self.x,)

    @property
    def module(self) -> str:
        return "disc_model.figures.attractors"


PLOTS: dict[str, type[Plot]] = {
    "stability_map": StabilityMap,
    "critical_speed": CriticalSpeed,
    "thresholds": Thresholds,
    "growth_map": GrowthMap,
    "bifurcation": Bifurcation,
}
