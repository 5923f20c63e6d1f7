"""What is drawn of critical values: growth rates, stretches of instability, and values without a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from disc_model.data.variables import axis_of, presentation_of
from disc_model.figures.drawing import mark, wide
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical


class Words(NamedTuple):
    """What a picture says of a kind of motion: its name, on its axis, and in its legend."""

    motion: str
    rate: str
    shaded: str
    computed: str
    missing: str


WORDS = {
    "stick_slip": Words(
        "motion near the static start",
        "Growth rate of the cycle (1/s)",
        "unstable near the static start",
        "cycles computed",
        "no cycle found",
    ),
    "sliding": Words(
        "steady sliding",
        "Growth rate of steady sliding (1/s)",
        "unstable steady sliding",
        "values computed",
        "no steady sliding",
    ),
}
OF_BOTH = "Growth rate of the cycle, or of sliding (1/s)"
MISSING = "disc_model_no_motion"


class Curve(NamedTuple):
    """What is drawn of critical values, in the unit of the axis.

    x : values of the parameter, (m,)
    rates, sliding : growth rates, and those of steady sliding where there is no cycle, 1/s, (m,)
    unstable : (n, 2), ends of the stretches of instability
    label, unit, factor : of the parameter
    """

    x: np.ndarray
    rates: np.ndarray
    sliding: np.ndarray
    unstable: np.ndarray
    words: Words
    label: str
    unit: str
    factor: float

    @classmethod
    def of(cls, critical: Critical) -> Curve:
        """What is drawn of critical values."""
        label, factor = axis_of(critical.name)
        sliding = critical.sliding_growth_rate
        if critical.kind == "sliding":
            sliding = np.full(critical.values.shape, np.nan)
        return cls(
            critical.values * factor,
            critical.growth_rate,
            sliding,
            critical.unstable * factor,
            WORDS[critical.kind],
            label,
            presentation_of(critical.name).unit,
            factor,
        )

    @property
    def has_sliding(self) -> bool:
        """Whether steady sliding takes the place of a cycle somewhere."""
        return bool(np.isfinite(self.sliding).any())

    @property
    def rate_label(self) -> str:
        """The label of the growth rates."""
        return OF_BOTH if self.has_sliding else self.words.rate

    @property
    def gone(self) -> np.ndarray:
        """Values without a motion whose growth rate is known."""
        return self.x[np.isnan(self.rates) & np.isnan(self.sliding)]


def draw_missing(ax: Axes, curve: Curve, height: float, colour: str, **options: Any) -> None:
    """Mark values without a motion at a height of the panel."""
    ax.plot(
        curve.gone,
        np.full(curve.gone.size, height),
        "x",
        color=colour,
        markersize=mark(3),
        markeredgewidth=wide(0.6),
        transform=ax.get_xaxis_transform(),
        gid=MISSING,
        **options,
    )
