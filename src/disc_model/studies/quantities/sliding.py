"""Complex eigenvalues: frequencies, growth rates and damping of the modes of steady sliding along
one parameter."""

from typing import Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import Variable, value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import (
    STATUS,
    Coordinate,
    Free,
    Point,
    Quantity,
    Range,
    listed,
    units_of,
)
from disc_model.units import Count, Unit

_ONE = ("value",)
_EACH = ("value", "mode")


class Sliding(Quantity):
    """Modes of steady sliding along one parameter, each keeping its number."""

    parameter: Free = "Omega"
    """number of the case that varies; with mu_k, mu_s rises where that is larger"""
    scan: Annotated[Range, Unit(of="parameter")]
    """values of the parameter"""
    modes: Annotated[Count, Field(ge=1, le=2000)] = 24
    """room for that many modes, numbered by frequency at the first value"""
    points_per_job: ClassVar = 60
    scans: ClassVar = ("parameter",)
    COLUMNS: ClassVar = {
        "status": STATUS,
        "n_modes": Variable("1", "number of modes", whole=True),
        "unstable_modes": Variable("1", "number of unstable modes", dims=_ONE, whole=True),
        "largest_growth_rate": Variable("s-1", "largest growth rate of steady sliding", dims=_ONE),
        "contact_force": Variable("N", "contact force of steady sliding", dims=_ONE),
        "frequency": Variable("Hz", "frequency of the mode in the slider's frame", dims=_EACH),
        "mode_growth_rate": Variable("s-1", "growth rate of the mode", dims=_EACH),
        "damping_ratio": Variable("1", "damping ratio of the mode", dims=_EACH),
        "diameters": Variable(
            "1", "nodal diameters of most energy, -1 in the plane", dims=_EACH, whole=True
        ),
        "forward_wave_fraction": Variable(
            "1", "share of energy in waves that travel with the slider", dims=_EACH
        ),
        "mac": Variable(
            "1",
            "likeness to the mode at the value before: squared cosine of the shapes",
            dims=_EACH,
        ),
    }
    COORDINATES: ClassVar = {
        "value": Coordinate("{0.units}", "{0.parameter}", lambda o: o.scan.values),
        "mode": Coordinate(
            "1",
            "number of the mode, lowest frequency first",
            lambda o: range(1, o.modes + 1),
            "modes",
        ),
    }

    @property
    def units(self) -> str:
        """The unit of the parameter."""
        return units_of(self.parameter)

    def _case_at(self, p: Parameters, value: float) -> Parameters:
        """The case of a point at a value of the parameter."""
        if self.parameter == "mu_k":
            return p.replace(mu_k=value, mu_s=max(p.mu_s, value))
        return p.replace(**{self.parameter: value})

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.sliding_modes import follow_modes

        p = point.parameters
        values = self.scan.values
        cases = [self._case_at(p, value) for value in values]
        followed = follow_modes(cases)
        counts = [int(numbers.max(initial=-1)) + 1 for _, _, numbers, _ in followed]
        n_modes = max(counts, default=0)
        shape = (len(values), max(n_modes, self.modes))
        message = ""
        columns = {
            name: column.empty(shape)
            for name, column in self.COLUMNS.items()
            if column.dims == _EACH
        }
        rows = []
        for i, (sliding, modes, numbers, mac) in enumerate(followed):
            row = {
                "frequency": modes.frequency,
                "mode_growth_rate": modes.growth_rate,
                "mac": mac,
                "damping_ratio": modes.damping_ratio,
                "diameters": modes.diameters,
                "forward_wave_fraction": modes.forward,
            }
            for name, column in row.items():
                columns[name][i, numbers] = column
            of_value = {
                "unstable_modes": sliding.growing.size,
                "contact_force": sliding.contact_force,
            }
            of_value["largest_growth_rate"] = sliding.growth_rate
            rows.append(of_value)
            if not sliding.status.exists:
                message = (
                    message or f"{value_with_unit(self.parameter, values[i])}: {sliding.message}"
                )
        return {**columns, **listed(rows), "n_modes": n_modes, "status": "ok"}, message
