"""One case ready to be run, and its content address. A workflow job is given one as text."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from disc_model.parameters import Parameters
from disc_model.simulation.record import Poincare, Record, Window
from disc_model.studies.start import Start


@dataclass(frozen=True)
class CaseSpec:
    """A case ready to be run: everything a simulation depends on, and nothing else (no titles)."""

    parameters: Parameters
    t_end: float
    tol: float
    stop_at: Literal["first_separation"] | None
    windows: tuple[tuple[str, Window], ...]
    poincare: Poincare | None
    events: tuple[float, float] | None
    energy: bool
    start: Start = field(default_factory=Start)
    truncation: str = ""
    """How the number of modes was chosen, as JSON; empty if it was given."""

    @property
    def record(self) -> Record:
        """What `disc_model.simulation.api` is asked to keep."""
        return Record(
            windows=tuple(window for _, window in self.windows),
            poincare=self.poincare,
            events=self.events is not None,
            energy=self.energy,
        )

    @property
    def sections(self) -> dict[str, Window | Poincare | None]:
        """Windows by name, and the Poincare section as ``poincare``."""
        return {**dict(self.windows), "poincare": self.poincare}

    @property
    def canonical(self) -> str:
        """JSON text, equal for equal cases however they were written; `from_canonical` reads it."""
        return canonical_json(
            {
                "parameters": self.parameters.model_dump(),
                "t_end": self.t_end,
                "tol": self.tol,
                "stop_at": self.stop_at,
                "windows": [[name, window.model_dump()] for name, window in self.windows],
                "poincare": self.poincare and self.poincare.model_dump(),
                "events": self.events,
                "energy": self.energy,
            }
            | ({"start": self.start.model_dump()} if self.start != Start() else {})
            | ({"truncation": self.truncation} if self.truncation else {})
        )

    @property
    def key(self) -> str:
        """First 12 hexadecimal digits of the sha256 of `canonical`."""
        return content_key(self.canonical)

    @classmethod
    def from_canonical(cls, text: str) -> CaseSpec:
        data = json.loads(text)
        return cls(
            parameters=Parameters(**data["parameters"]),
            t_end=data["t_end"],
            tol=data["tol"],
            stop_at=data["stop_at"],
            windows=tuple((name, Window(**window)) for name, window in data["windows"]),
            poincare=data["poincare"] and Poincare(**data["poincare"]),
            events=data["events"] and tuple(data["events"]),
            energy=data["energy"],
            start=Start.model_validate(data.get("start", {})),
            truncation=data.get("truncation", ""),
        )


def content_key(text: str) -> str:
    """First 12 hexadecimal digits of the sha256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def canonical_json(value: Any) -> str:
    """JSON with sorted keys; infinities as text, since JSON has none; -0.0 as 0.0."""

    def plain(item: Any) -> Any:
        if isinstance(item, Mapping):
            return {str(key): plain(value) for key, value in item.items()}
        if isinstance(item, list | tuple):
            return [plain(value) for value in item]
        if isinstance(item, float):
            return item + 0.0 if math.isfinite(item) else str(item)
        return item

    return json.dumps(plain(value), sort_keys=True, separators=(",", ":"), allow_nan=False)
