"""What the stability analyses need of a case."""

from __future__ import annotations

from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.schema import shown


def contact_faults(p: Parameters, analysis: str) -> list[str]:
    """What of a case ``analysis`` cannot do: without modes there is nothing that could lose its stability."""
    if p.n_diameters >= 0:
        return []
    return [Fault(("n_diameters",), shown(p.n_diameters), f"must be >= 0: {analysis} needs modes of the disc")]


def check_contact(p: Parameters, analysis: str) -> None:
    """Raise `ParameterError` where there are `contact_faults`."""
    if faults := contact_faults(p, analysis):
        raise ParameterError(*faults)
