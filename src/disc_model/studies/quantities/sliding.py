"""Complex eigenvalues: frequencies, growth rates and damping of the modes of steady sliding along
one parameter."""

from typing import Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES, value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import Coordinate, Free, Point, Quantity, Range, listed
from disc_model.units import Count, Unit

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
    COLUMNS: ClassVar = OF_QUANTITIES["sliding"]["columns"]
    COORDINATES: ClassVar = {
        "value": Coordinate(lambda o: o.scan.values),
        "mode": Coordinate(lambda o: range(1, o.modes + 1), "modes"),
    }

    def _case_at(self, p: Parameters, value: float) -> Parameters:
        """The case of a point at a value of the parameter."""
        if self.parameter == "mu_k":
            return p.replace(mu_k=value, mu_s=max(p.mu_s, value))
        return p.replace(**{self.parameter: value})

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.sliding import follow_modes

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
