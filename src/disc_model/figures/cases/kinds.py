"""The kinds of figures that any named case can have, and what a study file may say of each. Imports nothing heavy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from disc_model.figures.grids.kinds import Fault
from disc_model.figures.paper.catalogue import HIGHEST, spectrum_faults
from disc_model.parameters import Positive, Strict, Title
from disc_model.simulation.case import Poincare, Window

Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]
"""What samples hold beside their times and phases."""
RANGES = ("P", "u", "w", "w_point", "psi", "psi_velocity")
"""Of these, what a window with an envelope keeps."""
Recorded = Mapping[str, Window | Poincare | None]
"""What a case records: windows by name, and the Poincare section as ``poincare``."""


class CasePlot(Strict):
    """A figure of one named case, from one of its windows.

    case : name of the case
    window : name of the window under the case's ``record.windows``
    title : stands above the figure
    """

    kind: str
    case: str
    window: str
    title: Title = ""

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """What keeps it from being drawn; a case that is None has faults of its own."""
        if self.case not in cases:
            yield Fault(("case",), self.case, f"no such case (known: {', '.join(cases) or 'none'})")
        elif (recorded := cases[self.case]) is not None:
            found = recorded.get(self.window)
            if found is None:
                known = ", ".join(name for name, window in recorded.items() if window is not None)
                yield Fault(("window",), self.window, f"is not recorded by case {self.case} (known: {known or 'none'})")
            else:
                yield from self._misfits(found)

    def _misfits(self, window: Any) -> Iterator[Fault]:
        """Rules that a window breaks."""
        if isinstance(window, Poincare):
            yield Fault(("window",), self.window, "must be a window, not the Poincare section")
        elif window.envelope is not None:
            yield Fault(("window",), self.window, "must have no envelope")

    @property
    def cases(self) -> tuple[str, ...]:
        """The cases that it shows."""
        return (self.case,)


class History(CasePlot):
    """Variables against time, one above the other; a window with an envelope as ranges."""

    kind: Literal["history"] = "history"
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w")

    def _misfits(self, window: Any) -> Iterator[Fault]:
        if isinstance(window, Poincare):
            yield from super()._misfits(window)
            return
        if window.count < 2 * (window.envelope or 1):
            yield Fault(("window",), self.window, "must be two samples, or two envelopes, long or more")
        for i, name in enumerate(self.variables):
            if window.envelope is not None and name not in RANGES:
                yield Fault(("variables", str(i)), name, f"is not kept as ranges (known: {', '.join(RANGES)})")


class Section(CasePlot):
    """The Poincare sections of slider and disc: once a turn of the drive."""

    kind: Literal["poincare"] = "poincare"
    window: Literal["poincare"] = "poincare"

    def _misfits(self, window: Any) -> Iterator[Fault]:
        return iter(())


class Spectrogram(CasePlot):
    """Power of a variable over time and frequency, in dB below its strongest line.

    highest : Hz, frequency up to which it is shown
    """

    kind: Literal["spectrogram"] = "spectrogram"
    variable: Sampled = "w_point"
    highest: Positive = HIGHEST

    def _misfits(self, window: Any) -> Iterator[Fault]:
        yield from super()._misfits(window)
        if not isinstance(window, Poincare):
            for rule in spectrum_faults(window, self.highest):
                yield Fault(("window",), self.window, rule)


class Portrait(CasePlot):
    """One variable over another, coloured by phase."""

    kind: Literal["portrait"] = "portrait"
    x: Sampled = "psi"
    y: Sampled = "psi_velocity"


CASE_PLOTS: dict[str, type[CasePlot]] = {
    "history": History,
    "poincare": Section,
    "spectrogram": Spectrogram,
    "portrait": Portrait,
}
MODULE = "disc_model.figures.cases.draw"
"""Module that draws them: ``draw(cases, **options)`` with trees by case and what the file says."""
