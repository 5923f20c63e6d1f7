"""Which laws of contact the stability analyses know."""

from __future__ import annotations

from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.schema import shown


def contact_faults(p: Parameters, analysis: str) -> list[str]:
    """What of a case ``analysis`` cannot do yet: its variational equations are those of the paper's contact."""
    faults: list[str] = []
    if p.contact_compliance != 0:
        faults.append(_fault(p, "contact_compliance", f"{analysis} is not available yet, must be 0"))
    if p.contact_force != "vertical":
        faults.append(_fault(p, "contact_force", f"{analysis} is not available yet, must be 'vertical'"))
    if p.n_diameters < 0:
        faults.append(_fault(p, "n_diameters", f"{analysis} needs modes of the disc, must be >= 0"))
    return faults


def check_contact(p: Parameters, analysis: str) -> None:
    """Raise `ParameterError` where there are `contact_faults`."""
    if faults := contact_faults(p, analysis):
        raise ParameterError(*faults)


def _fault(p: Parameters, name: str, rule: str) -> Fault:
    return Fault((name,), shown(getattr(p, name)), rule)
