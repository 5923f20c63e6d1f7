"""Kinds of compiled kernels: the kinds that cases need, and their compilation ahead of the jobs.

A kind is determined by the task, the law of contact, and whether one block of lanes holds the modes.  Its name is that
of a job, such as ``floquet-rigid_normal-wide``.
"""

import json
import time
from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from typing import Any

from disc_model.parameters import AUTO, Disc, Parameters
from disc_model.simulation.case import CaseSpec

TASKS = ("simulate", "floquet", "ramp")
"""Motion; stick-slip cycle with multipliers, which needs the kernels of the motion as well; motion on a ramp."""
_COMPLIANCE = 2.7e-7
"""m/N; close to the residual flexibility, whose computation takes two seconds."""
LAWS: dict[str, dict[str, Any]] = {
    "rigid_vertical": {},
    "rigid_normal": {"contact_force": "normal"},
    "compliant_vertical": {"contact_compliance": _COMPLIANCE},
    "compliant_normal": {"contact_compliance": _COMPLIANCE, "contact_force": "normal"},
}
"""Laws of contact, beginning with the paper's, each with the parameters that select it."""
WIDTHS: dict[str, dict[str, Any]] = {"": {}, "-wide": {"n_diameters": 5}}
"""Widths, with parameters that select them: the pairs of modes fill one block of lanes, or more than one."""
PAIRS_OF_A_BLOCK = 4
KINDS = tuple(f"{task}-{law}{width}" for width, law, task in product(WIDTHS, LAWS, TASKS))
USUAL = tuple(kind for kind in KINDS if ("wide" in kind) + ("ramp" in kind) + ("rigid_vertical" not in kind) < 2)
"""Kinds that differ from the paper's in at most one respect: compile times are measured for them."""
DECIDING = frozenset({"contact_compliance", "contact_force", "n_diameters", "n_circles", "disc"})
"""Parameters that determine the kind of a case."""
_DEFAULTS = {name: Parameters.model_fields[name].default for name in DECIDING}


def kinds_of(cases: Iterable[Mapping[str, Any]], tasks: Iterable[str]) -> list[str]:
    """The kinds that tasks need for cases, given by parameter values, in the order of `KINDS`."""
    found = {f"{task}-{one}" for case in cases for one, task in product(_models(case), tasks)}
    return [kind for kind in KINDS if kind in found]


def kinds_of_case(spec: CaseSpec) -> list[str]:
    """The kinds that a named case needs, including its prerun and the choice of its modes."""
    values: dict[str, Any] = spec.parameters.model_dump()
    tasks = ["simulate"] + ["ramp"] * bool(spec.ramps)
    if spec.modes:
        values["n_diameters"] = AUTO
        tasks += ["floquet"] * (json.loads(spec.modes)["quantity"] == "growth")
    found = {*kinds_of([values], tasks)}
    if spec.start.prerun is not None:
        found |= {*kinds_of([values | spec.start.prerun.parameters], ["simulate"])}
    return [kind for kind in KINDS if kind in found]


def _models(values: Mapping[str, Any]) -> Iterator[str]:
    """Law and width of a case; both widths if its modes are still to be chosen."""
    known = {name: values.get(name, default) for name, default in _DEFAULTS.items()}
    law = f"{'compliant' if known['contact_compliance'] else 'rigid'}_{known['contact_force']}"
    disc, highest = known["disc"], known["n_diameters"]
    if disc is not None:
        diameters = disc.diameters if isinstance(disc, Disc) else disc["diameters"]
        pairs = sum(each > 0 for each in diameters)
    else:
        pairs = 0 if highest == AUTO else highest * (known["n_circles"] + 1)
    for width in WIDTHS:
        if highest == AUTO or (pairs > PAIRS_OF_A_BLOCK) == bool(width):
            yield law + width


def example(kind: str) -> Parameters:
    """A case that needs kernels of a kind."""
    _, law, *width = kind.split("-")
    return Parameters(N=385, Omega=15, **LAWS[law], **(WIDTHS["-wide"] if width else {}))


def compile_kernels(kind: str) -> float:
    """Compile the kernels of a kind, so that jobs find them in the cache; returns the time taken, s."""
    # imported here, so that a study can be read without the engine
    from disc_model.simulation.api import simulate
    from disc_model.simulation.ramps import Ramp
    from disc_model.stability.cycle import floquet

    began, p = time.perf_counter(), example(kind)
    if kind.startswith("floquet"):
        floquet(p)
    else:
        ramp = Ramp(parameter="Omega", to=5.0, start=0.0, end=400.0)
        simulate(p, 0.1, ramps=ramp if kind.startswith("ramp") else ())
    return time.perf_counter() - began
